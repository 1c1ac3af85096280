#include "goose/goose.hpp"

#include "geometry/conflict.hpp"
#include "host/stopwatch.hpp"
#include "query/pages/describe.hpp"

namespace abacus {

namespace {

template <int D> Side side_of(const abacus_simplex &row, const Point<D> &p) {
    std::array<Point<D>, D + 1> points;
    Corners<D> corners;
    for (int i = 0; i <= D; ++i) {
        std::copy_n(row.corner[i], D, points[i].begin());
        corners[i] = &points[i];
    }
    return row.ghost ? side_of_ghost<D>(corners, p) : side_of_simplex<D>(corners, p);
}

} // namespace

template <int D>
Goose<D>::Goose(const Host &host, const abacus_rtree &rtree, const abacus_facts &facts,
                abacus_goose_figures &figures)
    : host_(host), rtree_(rtree), boxes_(facts), figures_(figures), rim_(host), hits_(host),
      cavity_(host), filling_(host) {
    figures_ = {};
    figures_.unit = boxes_.unit();
}

template <int D> bool Goose<D>::found(abacus_host_status status) const {
    if (status == ABACUS_HOST_FAILED) throw HostFailure();
    return status == ABACUS_HOST_OK;
}

template <int D> void Goose<D>::add(const std::uint64_t *record) {
    const Stopwatch watch(figures_.total_ns);
    host_.poll();
    if (figures_.vertices == 0)
        hold(record);
    else
        insert(vertex_of(record));
}

template <int D> void Goose<D>::hold(const std::uint64_t *record) {
    const std::uint64_t number = held_.size();
    held_.write(host_, record, 1, stride);
    first_.offer(record_point<D>(record), number);
    if (first_count_ <= D && first_.contains(number))
        first_vertices_[first_count_++] = vertex_of(record);
    if (first_.is_complete()) start();
}

/// Inserts the first simplex with its ghosts, then the other points that were held.
template <int D> void Goose<D>::start() {
    Row simplex{first_vertices_, false};
    Corners<D> points;
    for (int i = 0; i <= D; ++i) points[i] = &simplex.vertex[i].point;
    if (orientation<D>(points) < 0) std::swap(simplex.vertex[0], simplex.vertex[1]);
    insert_row(simplex);
    for (int i = 0; i <= D; ++i) insert_row({ghost_on(simplex.vertex, i, Vertex{}), true});
    figures_.vertices = D + 1;
    figures_.simplices = 1;
    figures_.ghosts = D + 1;

    Record record;
    held_.rewind(host_);
    for (std::uint64_t i = 0; held_.read(host_, record.data(), 1, stride) > 0; ++i) {
        host_.poll();
        if (!first_.contains(i)) insert(vertex_of(record.data()));
    }
    held_.close(host_);
}

template <int D> void Goose<D>::insert(const Vertex &v) {
    if (!find_cavity(v.point)) {
        ++figures_.duplicates;
        return;
    }
    fill_cavity(v);
    ++figures_.vertices;
}

template <int D> bool Goose<D>::find_cavity(const Point<D> &p) {
    const abacus_boxed_simplex *rows = nullptr;
    std::size_t count = 0;
    {
        const Stopwatch watch(figures_.search_ns);
        std::array<double, D> scaled;
        boxes_.scale(p, scaled.data());
        found(rtree_.search(rtree_.context, scaled.data(), &rows, &count, &figures_.search_boxes));
    }
    ++figures_.searches;
    figures_.found += count;

    const Stopwatch watch(figures_.test_ns);
    hits_.clear();
    cavity_.clear();
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 256 == 255) host_.poll();
        const Side side = side_of<D>(rows[i].simplex, p);
        if (side == Side::vertex) return false;
        if (side == Side::outside) continue;
        hits_.push_back(&rows[i]);
        cavity_.push_back(&rows[i].simplex);
    }
    if (hits_.empty()) throw_corrupted("No simplex is in conflict with a new point.");
    return true;
}

template <int D> void Goose<D>::remove_cavity() {
    {
        const Stopwatch watch(figures_.unlink_ns);
        for (const abacus_boxed_simplex *row : hits_) {
            host_.poll();
            if (!found(rtree_.unlink(rtree_.context, row, &figures_.unlink_boxes)))
                throw_corrupted("A simplex is not found by its box.");
        }
    }
    const Stopwatch watch(figures_.erase_ns);
    for (const abacus_boxed_simplex *row : hits_) {
        found(rtree_.erase(rtree_.context, row));
        --(row->simplex.ghost ? figures_.ghosts : figures_.simplices);
        ++figures_.deleted;
    }
}

template <int D> void Goose<D>::fill_cavity(const Vertex &v) {
    // The new row on each facet of the rim is the row inside, with v in place of the corner
    // opposite the facet. v lies on the same side, so the orientation stays, and infinity stays
    // last.
    filling_.clear();
    for (const auto &rim : rim_.find({cavity_.data(), cavity_.size()})) {
        const abacus_simplex &inside = *cavity_[rim.row];
        Row &row = *filling_.extend(1);
        row.ghost = inside.ghost && rim.facet != D;
        for (int i = 0; i <= D; ++i) {
            row.vertex[i].id = inside.id[i];
            std::copy_n(inside.corner[i], D, row.vertex[i].point.begin());
        }
        row.vertex[rim.facet] = v;
    }
    remove_cavity();
    for (const Row &row : filling_) {
        host_.poll();
        insert_row(row);
        ++(row.ghost ? figures_.ghosts : figures_.simplices);
    }
}

template <int D> void Goose<D>::insert_row(const Row &row) {
    abacus_boxed_simplex boxed{};
    DescribedCorners<D> corners;
    for (int i = 0; i < D + !row.ghost; ++i) {
        corners.id[i] = row.vertex[i].id;
        corners.point[i] = &row.vertex[i].point;
    }
    describe(corners, 0, row.ghost, boxed.simplex);
    boxes_.enclose(boxed);
    const Stopwatch watch(figures_.insert_ns);
    found(rtree_.insert(rtree_.context, &boxed));
    ++figures_.created;
}

template class Goose<2>;
template class Goose<3>;

} // namespace abacus
