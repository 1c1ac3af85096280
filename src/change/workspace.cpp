#include "change/workspace.hpp"

#include "attributes/rewriting.hpp"
#include "blocks/counters.hpp"
#include "keys/domain_of.hpp"
#include "mesh/page_attributes.hpp"

namespace abacus {

namespace {
/// Each page is loaded once, and the pages written show how much the next ones may hold. So a cache
/// for a few pages does better than a large one.
constexpr std::size_t pass_bytes = std::size_t{1} << 20;
} // namespace

template <int D>
Workspace<D>::Core::Core(const Host &host, const abacus_facts &facts, std::size_t cache_bytes,
                         AttributePages<D> *attributes)
    : cache(host, domain_of<D>(facts.form), page_attributes(facts.columns),
            CacheOptions{.budget = cache_bytes}),
      mesh(host, cache, static_cast<std::int64_t>(facts.census.simplices),
           static_cast<std::int64_t>(facts.census.ghosts)),
      insertion(mesh), removal(mesh, attributes) {}

template <int D>
Workspace<D>::Workspace(const Host &the_host, const abacus_facts &the_facts, std::size_t the_bytes)
    : host(the_host), in_hand(host), cache_host(host, in_hand),
      attributes(the_facts.columns.attributes), cache_bytes(the_bytes), budget(the_bytes),
      domain(domain_of<D>(the_facts.form)),
      repeated(std::in_place, host, domain, the_facts.columns.attributes) {
    if (the_facts.columns.apart != 0) apart.emplace(host, domain, the_facts.columns.attributes);
    make_core(the_facts);
}

template <int D> void Workspace<D>::make_core(const abacus_facts &of) {
    core.emplace(cache_host, of, budget, apart ? &*apart : nullptr);
    core->mesh.is_constrained = of.standing == ABACUS_CONSTRAINED;
    core->removal.set_lines(lines);
    if (changes != nullptr) core->mesh.log = &changes->log();
}

template <int D> void Workspace<D>::set_lines(LineSource *source) {
    lines = source;
    core->removal.set_lines(source);
}

template <int D> void Workspace<D>::log_to(SimplexChanges<D> &log) {
    changes = &log;
    core->mesh.log = &log.log();
}

template <int D> VertexIndex Workspace<D>::create(const std::uint64_t *record) {
    const Point<D> p = record_point<D>(record);
    if (apart) apart->put(p, domain.code(p), record_attributes<D>(record));
    return core->cache.create_vertex(p, record_id(record), record_attributes<D>(record));
}

template <int D> void Workspace<D>::start(const std::array<VertexIndex, D + 1> &vertices) {
    core->insertion.start(vertices);
    facts->census.vertices = D + 1;
}

template <int D> void Workspace<D>::read_vertex(VertexIndex v, std::uint64_t *record) {
    const VertexHeap<D> &vertices = core->cache.vertices();
    const Vertex<D> &vertex = vertices[v];
    fill_record<D>(record, vertices.id(v), vertex.point, vertices.attributes(v),
                   static_cast<std::size_t>(vertices.attribute_count()));
    if (!apart) return;
    std::array<double, ABACUS_MAX_ATTRIBUTES> values;
    apart->get(vertex.point, vertex.code, values.data());
    fill_record<D>(record, vertices.id(v), vertex.point, values.data(), attributes);
}

template <int D> void Workspace<D>::rename(const Point<D> &p, const std::uint64_t *record) {
    core->removal.rename(p, record_id(record), record_attributes<D>(record));
    if (apart) apart->put(p, domain.code(p), record_attributes<D>(record));
}

template <int D> void Workspace<D>::forget_repeated(const Point<D> &p) {
    count_repeated_taken(repeated->take_all(p));
}

template <int D> void Workspace<D>::count_repeated_taken(std::uint64_t taken) {
    if (taken > facts->census.duplicates)
        throw_corrupted("There are more repeated points than the header counts.");
    facts->census.duplicates -= taken;
}

template <int D> void Workspace<D>::erase_pages(abacus_page_kind kind) {
    abacus_page page;
    for (bool more = host.next(kind, nullptr, page); more;
         more = host.next(kind, &page.key, page)) {
        host.erase(kind, page);
        host.poll();
    }
}

/// Reports every simplex as removed to the log. Their codes are those that they have from now on:
/// the header may have another domain by now.
template <int D> void Workspace<D>::log_all_gone() {
    if (changes == nullptr || !has_simplices()) return;
    const Domain<D> now = domain_of<D>(facts->form);
    Cache<D> &cache = core->cache;
    for (Key page = first_key; page < end_key;) {
        cache.trim();
        cache.poll();
        page = cache.visit(page, [&](Handle h) { changes->log().go(cache, h, now); });
    }
}

template <int D> void Workspace<D>::forget_simplices() {
    log_all_gone();
    erase_pages(ABACUS_SIMPLEX_PAGES);
    if (apart) {
        apart->forget();
        erase_attributes(host, first_group<1>);
    }
    facts->census.vertices = facts->census.duplicates = facts->census.simplices =
        facts->census.ghosts = 0;
    facts->census.lines_wait = facts->census.lines > 0 ? 1 : 0;
    forget_cache();
}

template <int D> CacheOptions Workspace<D>::pass_options(const FormerAttributes &former) const {
    return {.budget = std::min(cache_bytes, pass_bytes),
            .linked_ghosts = abacus_links_ghosts(facts->standing) != 0,
            .split_nodes = facts->census.split > 0,
            .former = former};
}

template <int D> void Workspace<D>::forget_cache() {
    const abacus_counters kept = core->cache.counters;
    make_core(*facts);
    core->cache.counters = kept;
}

template <int D> void Workspace<D>::flush() {
    core->cache.flush();
    repeated->flush();
    repeated->forget(); // before the next change others may write the table of its pages anew
    if (!apart) return;
    apart->flush();
    apart->forget();
    core->cache.counters += apart->take_counters();
}

template <int D>
void Workspace<D>::report(abacus_phase phase, std::uint64_t done, std::uint64_t total) {
    const PagesMoved moved = pages_moved();
    host.progress({phase, done, total, moved.read, moved.written, 0});
}

template struct Workspace<2>;
template struct Workspace<3>;

} // namespace abacus
