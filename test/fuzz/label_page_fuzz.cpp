// Damaged pages of labels of simplices and of markers of facets. Except in tests of checksums,
// pages are sealed again.
#include "fuzz/fuzz_mesh.hpp"

#include <cmath>

using namespace abacus::fuzz;

namespace {

/// Calls take(simplex) for each simplex, or for those with a label in a range, after reading its
/// labels.
template <class Take>
void each_simplex(Mesh &mesh, Take take, const abacus_range *range = nullptr) {
    mesh.run([&](abacus_error &error) {
        abacus_window window{};
        abacus_cells *cells = nullptr;
        const abacus_extent all{};
        abacus_status status = abacus_cells_open(mesh.host.table(), &mesh.header.facts, &window,
                                                 &all, range, &cells, &error);
        if (status != ABACUS_OK) return status;
        abacus_simplex simplex;
        const double *labels = nullptr;
        while ((status = abacus_cells_next(cells, &simplex, nullptr, &error)) == ABACUS_OK &&
               (status = abacus_cells_labels(cells, &simplex, &labels, &error)) == ABACUS_OK)
            take(simplex);
        abacus_cells_close(cells);
        return status;
    });
}

void name(std::vector<std::uint64_t> &rows, const Mesh &mesh, const abacus_simplex &simplex) {
    rows.push_back(simplex.code);
    rows.insert(rows.end(), simplex.id, simplex.id + mesh.header.facts.form.dimension + 1);
}

/// Gives all simplices two labels.
void label(Mesh &mesh) {
    std::vector<std::uint64_t> rows;
    each_simplex(mesh, [&](const abacus_simplex &simplex) {
        name(rows, mesh, simplex);
        for (int i = 0; i < 2; ++i)
            rows.push_back(std::bit_cast<std::uint64_t>(double(rows.size() % 7)));
    });
    mesh.run([&](abacus_error &error) {
        const std::uint32_t numbers[] = {0, 1};
        const std::size_t words = mesh.header.facts.form.dimension + 4;
        abacus_header named = mesh.header;
        named.facts.columns.labels = 2;
        for (unsigned i = 0; i < 2; ++i)
            std::strcpy(named.names[named.facts.columns.attributes + i],
                        i == 0 ? "material" : "age");
        abacus_labelling *labelling = nullptr;
        abacus_status status =
            abacus_labelling_open(mesh.host.table(), &named.facts, mesh.header.facts.columns.labels,
                                  numbers, 2, 1 << 20, 1 << 20, &labelling, &error);
        if (status != ABACUS_OK) return status;
        status = abacus_labelling_add(labelling, rows.data(), rows.size() / words, &error);
        if (status == ABACUS_OK) status = abacus_labelling_end(labelling, &named, &error);
        abacus_labelling_close(labelling);
        if (status == ABACUS_OK) mesh.header = named;
        return status;
    });
}

/// Gives a facet of each simplex a marker, or removes it.
void mark(Mesh &mesh) {
    std::vector<std::uint64_t> rows;
    each_simplex(mesh, [&](const abacus_simplex &simplex) {
        name(rows, mesh, simplex);
        rows.push_back(simplex.code % (mesh.header.facts.form.dimension + 1));
        const double marker = simplex.code % 5 == 0 ? NAN : double(simplex.code % 7);
        rows.push_back(std::bit_cast<std::uint64_t>(marker));
    });
    mesh.run([&](abacus_error &error) {
        const std::size_t words = mesh.header.facts.form.dimension + 4;
        abacus_marking *marking = nullptr;
        abacus_status status = abacus_marking_open(mesh.host.table(), &mesh.header.facts, 1 << 20,
                                                   1 << 20, &marking, &error);
        if (status != ABACUS_OK) return status;
        status = abacus_marking_add(marking, rows.data(), rows.size() / words, &error);
        if (status == ABACUS_OK) status = abacus_marking_end(marking, &mesh.header, &error);
        abacus_marking_close(marking);
        return status;
    });
}

void read_facets(Mesh &mesh) {
    mesh.run([&](abacus_error &error) {
        abacus_facets *facets = nullptr;
        abacus_status status = abacus_facets_open(mesh.host.table(), &mesh.header.facts, NAN,
                                                  1 << 20, 1 << 20, &facets, &error);
        if (status != ABACUS_OK) return status;
        abacus_facet facet;
        while ((status = abacus_facets_next(facets, &facet, &error)) == ABACUS_OK) {
        }
        abacus_facets_close(facets);
        return status;
    });
}

/// Points with unique ids, so that each simplex can be named.
const Mesh &labelled_mesh(int dimension) {
    static Mesh meshes[2];
    Mesh &mesh = meshes[dimension - 2];
    if (mesh.header.facts.form.dimension == 0) {
        mesh.header.facts.form.dimension = static_cast<std::uint32_t>(dimension);
        mesh.header.facts.form.has_domain = 1;
        std::fill_n(mesh.header.facts.form.upper, dimension, 1.0);
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> unit(0, 1);
        mesh.run([&](abacus_error &error) {
            abacus_stage *stage = nullptr;
            abacus_status status =
                abacus_stage_open(mesh.host.table(), &mesh.header.facts, 1 << 20, &stage, &error);
            for (std::uint64_t id = 2000; id < 2500 && status == ABACUS_OK; ++id) {
                std::vector<std::uint64_t> record{id};
                for (int i = 0; i < dimension; ++i)
                    record.push_back(std::bit_cast<std::uint64_t>(unit(random)));
                status = abacus_stage_add(stage, record.data(), 1, &error);
            }
            if (status == ABACUS_OK)
                status = abacus_stage_finish(stage, &mesh.header.facts, &error);
            abacus_stage_close(stage);
            return status;
        });
        require(mesh.build() == ABACUS_OK, "the mesh cannot be built");
        label(mesh);
        mark(mesh);
        mesh.header.facts.columns.inherits = dimension == 3;
        require(mesh.header.facts.census.labelled > 0 && mesh.header.facts.census.marked > 0 &&
                    mesh.check() == 0,
                "the mesh is not sound");
    }
    return mesh;
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
    auto seeds = page_seeds(labelled_mesh(2).host.attribute_pages, {2, 0});
    for (auto &seed : page_seeds(labelled_mesh(3).host.attribute_pages, {3, 1}))
        seeds.push_back(seed);
    write_seeds(*argc, *argv, seeds);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes input(data, size);
    const Mesh &sound = labelled_mesh(input.next<std::uint8_t>() % 2 == 0 ? 2 : 3);
    const bool sealed = input.next<std::uint8_t>() % 4 != 0;
    Mesh mesh;
    mesh.host.restore(sound.host);
    mesh.header = sound.header;
    damage(mesh.host.attribute_pages, input);
    if (sealed) seal(mesh.host.attribute_pages);
    mesh.locate_places();
    const abacus_range some{1, 2, 4};
    each_simplex(
        mesh, [](const abacus_simplex &) {}, &some);
    read_facets(mesh);
    mesh.check();
    label(mesh);
    mark(mesh);
    mesh.check();
    mesh.stage(20, 3);
    mesh.build();
    mesh.remove(80, 1);
    mesh.check();
    require(mesh.host.bytes == 0, "memory is not given back");
    return 0;
}
