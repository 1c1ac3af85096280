// Reading octrees, behind the C interface.
#include "octree/octree_nodes.hpp"
#include "octree/octree_scan.hpp"

#include "capi/dispatch.hpp"
#include "capi/handle.hpp"
#include "capi/octree_handle.hpp"

namespace abacus {
namespace {

/// Leaves of a window, or all of them.
template <int D> class WindowScan {
public:
    WindowScan(const Host &host, const abacus_facts &facts, const abacus_window &window,
               std::size_t cache_bytes)
        : leaves_(open(host, facts, window, cache_bytes)) {}

    bool next(abacus_octant &octant) {
        Octant<D> leaf;
        const double *values;
        if (!leaves_.next(leaf, values)) return false;
        describe<D>(leaves_.grid(), leaf, values, octant);
        return true;
    }

private:
    static OctreeScan<D> open(const Host &host, const abacus_facts &facts,
                              const abacus_window &window, std::size_t cache_bytes) {
        if (window.kind == ABACUS_NO_WINDOW) return {host, facts};
        if (window.kind == ABACUS_BALL_WINDOW)
            return {host, facts, Ball<D>{place_of<D>(window.center), window.radius}, cache_bytes};
        return {host, facts, Box<D>(place_of<D>(window.lower), place_of<D>(window.upper)),
                cache_bytes};
    }

    OctreeScan<D> leaves_;
};

template <int D> class NodeList {
public:
    NodeList(const Host &host, const abacus_facts &facts, std::size_t memory)
        : grid_(facts.form), nodes_(host, facts, memory) {}

    bool next(abacus_octree_node &to) {
        typename OctreeNodes<D>::Node node;
        if (!nodes_.next(node)) return false;
        to.number = node.number;
        for (int i = 0; i < D; ++i) to.point[i] = grid_.line(i, node.point[i]);
        to.anchors = node.anchors;
        std::copy_n(node.anchor.begin(), node.anchors, to.anchor);
        return true;
    }

private:
    Grid<D> grid_;
    OctreeNodes<D> nodes_;
};

template <int D> class ElementList {
public:
    ElementList(const Host &host, const abacus_facts &facts, std::size_t memory)
        : grid_(facts.form), elements_(host, facts, memory) {}

    bool next(abacus_octant &octant, std::uint64_t *corners) {
        std::array<std::uint64_t, Octant<D>::children> numbers;
        if (!elements_.next(numbers)) return false;
        std::copy(numbers.begin(), numbers.end(), corners);
        describe<D>(grid_, elements_.scan().leaf(), elements_.scan().values(), octant);
        return true;
    }

private:
    Grid<D> grid_;
    OctreeElements<D> elements_;
};

} // namespace
} // namespace abacus

struct abacus_octree_scan {
    abacus_octree_scan(const abacus_host *table, const abacus_facts &facts,
                       const abacus_window &window, std::size_t cache_bytes)
        : host(*table), scan(host, facts, window, cache_bytes) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::WindowScan> scan;
};

struct abacus_octree_nodes {
    abacus_octree_nodes(const abacus_host *table, const abacus_facts &facts, std::size_t memory)
        : host(*table), nodes(host, facts, memory) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::NodeList> nodes;
};

struct abacus_octree_elements {
    abacus_octree_elements(const abacus_host *table, const abacus_facts &facts, std::size_t memory)
        : host(*table), elements(host, facts, memory) {}

    const abacus::Host host;
    abacus::ByDimension<abacus::ElementList> elements;
};

abacus_status abacus_octree_open(const abacus_host *host, const abacus_facts *facts,
                                 size_t cache_bytes, abacus_octree **octree, abacus_error *error) {
    return abacus::guard(error, [&] {
        *octree = abacus::create_handle<abacus_octree>(host, *facts, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_locate(abacus_octree *octree, const double *place,
                                   abacus_octant *octant, abacus_error *error) {
    return abacus::guard(error, [&] {
        return octree->reader.visit([&]<int D>(abacus::OctreeReader<D> &reader) {
            const abacus::Handle h = reader.locate(abacus::place_of<D>(place));
            if (h == abacus::no_handle) return ABACUS_END;
            abacus::describe<D>(reader, h, *octant);
            return ABACUS_OK;
        });
    });
}

abacus_status abacus_octree_neighbours(abacus_octree *octree, uint64_t code,
                                       abacus_octant_report report, void *context,
                                       abacus_error *error) {
    return abacus::dispatch(octree->reader, error, [&]<int D>(abacus::OctreeReader<D> &reader) {
        if (code >= abacus::domain_cells<D>)
            throw abacus::Error(ABACUS_ERROR_ARGUMENT,
                                "no octant has the code " + std::to_string(int64_t(code)));
        reader.neighbours(code, [&](int axis, int side, abacus::Handle h) {
            abacus_octant octant;
            abacus::describe<D>(reader, h, octant);
            abacus::host::require(report(context, axis, side, &octant));
        });
    });
}

void abacus_octree_counters(const abacus_octree *octree, abacus_counters *counters) {
    octree->reader.visit([&](const auto &reader) { *counters = reader.cache().counters; });
}

void abacus_octree_close(abacus_octree *octree) { abacus::destroy_handle(octree); }

abacus_status abacus_octree_scan_open(const abacus_host *host, const abacus_facts *facts,
                                      const abacus_window *window, size_t cache_bytes,
                                      abacus_octree_scan **scan, abacus_error *error) {
    return abacus::guard(error, [&] {
        *scan = abacus::create_handle<abacus_octree_scan>(host, *facts, *window, cache_bytes);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_scan_next(abacus_octree_scan *scan, abacus_octant *octant,
                                      abacus_error *error) {
    return abacus::guard(error, [&] {
        return scan->scan.visit(
            [&](auto &leaves) { return leaves.next(*octant) ? ABACUS_OK : ABACUS_END; });
    });
}

void abacus_octree_scan_close(abacus_octree_scan *scan) { abacus::destroy_handle(scan); }

abacus_status abacus_octree_nodes_open(const abacus_host *host, const abacus_facts *facts,
                                       size_t memory, abacus_octree_nodes **nodes,
                                       abacus_error *error) {
    return abacus::guard(error, [&] {
        *nodes = abacus::create_handle<abacus_octree_nodes>(host, *facts, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_nodes_next(abacus_octree_nodes *nodes, abacus_octree_node *node,
                                       abacus_error *error) {
    return abacus::guard(error, [&] {
        return nodes->nodes.visit(
            [&](auto &list) { return list.next(*node) ? ABACUS_OK : ABACUS_END; });
    });
}

void abacus_octree_nodes_close(abacus_octree_nodes *nodes) { abacus::destroy_handle(nodes); }

abacus_status abacus_octree_elements_open(const abacus_host *host, const abacus_facts *facts,
                                          size_t memory, abacus_octree_elements **elements,
                                          abacus_error *error) {
    return abacus::guard(error, [&] {
        *elements = abacus::create_handle<abacus_octree_elements>(host, *facts, memory);
        return ABACUS_OK;
    });
}

abacus_status abacus_octree_elements_next(abacus_octree_elements *elements, abacus_octant *octant,
                                          uint64_t *corners, abacus_error *error) {
    return abacus::guard(error, [&] {
        return elements->elements.visit(
            [&](auto &list) { return list.next(*octant, corners) ? ABACUS_OK : ABACUS_END; });
    });
}

void abacus_octree_elements_close(abacus_octree_elements *elements) {
    abacus::destroy_handle(elements);
}
