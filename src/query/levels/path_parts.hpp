// The parts of a path that are in a polygon, or on its border: each segment is cut exactly, and its
// ends are rounded once (geometry/polygon.hpp).
#pragma once

#include "geometry/polygon.hpp"

namespace abacus {

class PathParts {
public:
    explicit PathParts(const Host &host) : host_(host), part_(host), first_(host) {}

    /// Calls put(part, is_closed) for each part, in order. The last point of a closed path is the
    /// first; its part across this point is one, and comes last.
    template <class Put>
    void each(const Polygon &polygon, const Arena<Point<2>> &path, bool is_closed, Put put) {
        part_.clear();
        first_.clear();
        bool is_first = is_closed; // the part that begins where the path does is kept
        const auto end = [&] {
            if (part_.size() > 1) {
                if (is_first && part_[0] == path[0])
                    first_.swap(part_);
                else
                    put(part_, false);
            }
            is_first = false;
            part_.clear();
        };
        for (std::size_t i = 1; i < path.size(); ++i) {
            bool ends_inside = false;
            host_.poll();
            polygon.cut(path[i - 1], path[i], [&](const Polygon::Stretch &stretch) {
                if (stretch.from > 0) end();
                if (part_.empty()) part_.push_back(stretch.first);
                if (!(part_.back() == stretch.last)) part_.push_back(stretch.last);
                ends_inside = stretch.to == 1;
            });
            if (!ends_inside) end();
        }
        if (part_.empty())
            part_.swap(first_);
        else if (is_first)
            return put(part_, true);
        else // across the first point
            for (std::size_t i = 1; i < first_.size(); ++i) part_.push_back(first_[i]);
        if (part_.size() > 1) put(part_, false);
    }

private:
    const Host &host_;
    Arena<Point<2>> part_, first_;
};

} // namespace abacus
