#include "query/pictures/ray_portrait.hpp"

#include "draw/ray_canvas.hpp"
#include "keys/domain_of.hpp"
#include "query/pages/vertex_values.hpp"
#include "query/scan/cell_filter.hpp"
#include "sort/pacer.hpp"

namespace abacus {

namespace {

class RayPortrait {
public:
    RayPortrait(const Host &host, const abacus_facts &facts, const abacus_camera &camera,
                const abacus_drawing &drawing)
        : host_(host), attribute_(drawing.attribute), vertex_values_(host, facts),
          box_(box_of(drawing)), camera_(camera, drawing, box_ ? *box_ : domain_box<3>(facts.form)),
          filter_(window_of(box_), drawing.extent), pages_(host, facts, filter_.region()),
          pacer_(host), total_(box_ ? 0 : facts.census.simplices + facts.census.ghosts) {
        if (camera_.has_parallel_rays()) fit();
    }

    Portrait draw(abacus_ray_mode mode, const abacus_drawing &drawing) {
        RayCanvas canvas(host_, camera_, mode, box_);
        each_page([&](const PageView<3> &page) {
            for (int v = 0; v < page.vertices(); ++v)
                sights_[v] = camera_.see(page.point(v), value(page, v));
            for (int s = 0; s < page.simplices(); ++s)
                if (!page.is_ghost(s) && filter_.wants(page, s))
                    canvas.add(sights_[page.corner(s, 0)], sights_[page.corner(s, 1)],
                               sights_[page.corner(s, 2)], sights_[page.corner(s, 3)]);
        });
        return {canvas.png(drawing), canvas.is_blank()};
    }

private:
    static std::optional<Box<3>> box_of(const abacus_drawing &drawing) {
        if (shows_whole<3>(drawing)) return std::nullopt;
        Box<3> box;
        std::copy_n(drawing.lower, 3, box.lower.begin());
        std::copy_n(drawing.upper, 3, box.upper.begin());
        return box;
    }
    static abacus_window window_of(const std::optional<Box<3>> &box) {
        abacus_window window{};
        if (!box) return window;
        window.kind = ABACUS_BOX_WINDOW;
        std::copy_n(box->lower.begin(), 3, window.lower);
        std::copy_n(box->upper.begin(), 3, window.upper);
        return window;
    }

    /// Without an attribute, the picture shows lengths: the integral of 1.
    double value(const PageView<3> &page, int vertex) const {
        return attribute_ >= 0 ? vertex_values_.value(page, vertex, attribute_) : 1;
    }

    template <class Visit> void each_page(Visit visit) {
        std::uint64_t done = 0;
        pacer_.begin(ABACUS_PHASE_SCANNING, total_);
        while (pages_.advance()) {
            visit(pages_.page());
            pacer_.reached(done += static_cast<std::uint64_t>(pages_.page().simplices()));
        }
    }

    /// Fits the picture to the box, or to all tetrahedra.
    void fit() {
        Box<2> around;
        if (box_) {
            for (int i = 0; i < 8; ++i) around.extend(camera_.place(box_->corner(i)));
        } else {
            each_page([&](const PageView<3> &page) {
                for (int s = 0; s < page.simplices(); ++s)
                    if (!page.is_ghost(s) && filter_.wants(page, s))
                        for (int i = 0; i < 4; ++i)
                            around.extend(camera_.place(page.point(page.corner(s, i))));
            });
            pages_.rewind();
        }
        camera_.fit(around);
    }

    const Host &host_;
    const int attribute_;
    const VertexValues<3> vertex_values_;
    const std::optional<Box<3>> box_;
    Camera camera_;
    const CellFilter<3> filter_;
    RangeScan<3> pages_;
    Pacer pacer_;
    const std::uint64_t total_; // simplices; 0: not known
    std::array<Sight, page_vertices<3>> sights_;
};

} // namespace

Portrait draw_rays(const Host &host, const abacus_facts &facts, const abacus_camera &camera,
                   const abacus_drawing &drawing) {
    check_drawing(drawing);
    if (drawing.attribute >= static_cast<std::int32_t>(facts.columns.attributes))
        throw Error(ABACUS_ERROR_ARGUMENT, "the mesh has no such attribute");
    const abacus_ray_mode mode = drawing.attribute < 0 ? ABACUS_RAY_SUM : camera.mode;
    RayPortrait portrait(host, facts, camera, drawing);
    return portrait.draw(mode, drawing);
}

} // namespace abacus
