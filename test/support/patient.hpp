// A mesh that tests damage again and again, and heal after each time.
#pragma once

#include "support/checked_by_threads.hpp"
#include "support/page_editor.hpp"

#include <abacus/mesh_header.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

namespace abacus::test {

inline std::vector<Input> random_points(int n, int attributes, unsigned seed = 1) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Input> inputs;
    for (int i = 0; i < n; ++i) {
        inputs.push_back({1000 + i, {unit(random), unit(random)}});
        for (int k = 0; k < attributes; ++k) inputs.back().attributes.push_back(unit(random));
    }
    return inputs;
}

/// A mesh and its sound state, to which it returns after each damage.
class Patient {
public:
    Patient(int points, int attributes, std::size_t cache_bytes = 64 << 20)
        : Patient(random_points(points, attributes), cache_bytes) {}
    explicit Patient(const std::vector<Input> &points, std::size_t cache_bytes = 64 << 20)
        : mesh(static_cast<int>(points[0].attributes.size()), cache_bytes), input(points) {
        EXPECT_EQ(mesh.stage(input), ABACUS_OK);
        EXPECT_EQ(mesh.build(), ABACUS_OK) << mesh.error.detail;
        keep();
    }

    /// Makes the present state the one to which the mesh returns.
    void keep() {
        pages_ = mesh.host.pages;
        staged_pages_ = mesh.host.staged_pages;
        repeated_pages_ = mesh.host.repeated_pages;
        attribute_pages_ = mesh.host.attribute_pages;
        header_ = mesh.header;
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
    }

    /// The faults after `damage`; afterwards the mesh is sound again. `by_threads`: several threads
    /// must find the same faults.
    std::vector<std::string> faults(const std::function<void()> &damage, bool by_threads = false) {
        damage();
        const std::vector<std::string> found = mesh.check();
        if (by_threads) expect_same_faults_by_threads(mesh);
        EXPECT_EQ(mesh.host.violations, std::vector<std::string>{});
        EXPECT_EQ(mesh.host.bytes, 0u);
        mesh.host.pages = pages_;
        mesh.host.staged_pages = staged_pages_;
        mesh.host.repeated_pages = repeated_pages_;
        mesh.host.attribute_pages = attribute_pages_;
        mesh.header = header_;
        return found;
    }
    void expect_fault(const char *what, const char *kind, const std::function<void()> &damage) {
        const std::vector<std::string> found = faults(damage, true);
        const std::string start = std::string(kind) + ": ";
        const bool has_kind = std::any_of(found.begin(), found.end(), [&](const std::string &f) {
            return f.compare(0, start.size(), start) == 0;
        });
        EXPECT_TRUE(has_kind) << what << " gives " << testing::PrintToString(found);
    }

    MemoryHost::Page &page(std::size_t i = 0) {
        return std::next(mesh.host.pages.begin(), static_cast<std::ptrdiff_t>(i))->second;
    }
    MemoryHost::Page &smallest() {
        return std::min_element(
                   mesh.host.pages.begin(), mesh.host.pages.end(),
                   [](const auto &a, const auto &b) { return a.second.size < b.second.size; })
            ->second;
    }
    MemoryHost::Page &middle() { return page(mesh.host.pages.size() / 2); }
    /// Changes a page, taken apart.
    void edit(MemoryHost::Page &page, const std::function<void(PageEditor &)> &change) {
        PageEditor editor(page, mesh.header);
        change(editor);
        editor.write(page);
    }
    /// Changes every page that has the vertex at p: change(page, vertex number).
    void edit_vertex(const Point<2> &p, const std::function<void(PageEditor &, int)> &change) {
        for (auto &[key, page] : mesh.host.pages) {
            PageEditor editor(page, mesh.header);
            const int v = editor.number_of(p);
            if (v < 0) continue;
            change(editor, v);
            editor.write(page);
        }
    }

    Mesh mesh;
    std::vector<Input> input;

private:
    MemoryHost::Pages pages_, staged_pages_, repeated_pages_, attribute_pages_;
    abacus_header header_;
};

} // namespace abacus::test
