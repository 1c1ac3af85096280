// The input points as the oracle sees them: distinct points numbered in
// lexicographic order, and the way from a user's id to that number.
#pragma once

#include "coordinates.hpp"
#include "copy_format.hpp"

#include <algorithm>
#include <unordered_map>

namespace abacus::oracle {

template <int D> class PointTable {
public:
    static constexpr std::uint32_t unknown = ~std::uint32_t(0);

    /// Reads rows (id, coordinates) in binary COPY format. Ids must be unique.
    explicit PointTable(const std::string &path) {
        struct Record {
            Coordinates<D> point;
            std::int64_t id;
        };
        std::vector<Record> records;
        File file(path, "r");
        CopyReader<D + 1> reader(file);
        std::array<std::uint64_t, D + 1> row;
        while (reader.next(row)) {
            Record record;
            record.id = std::int64_t(row[0]);
            for (int i = 0; i < D; ++i) // adding 0.0 turns -0.0 into 0.0
                record.point[i] = std::bit_cast<double>(row[i + 1]) + 0.0;
            records.push_back(record);
        }
        count_ = records.size();

        std::stable_sort(records.begin(), records.end(),
                         [](const Record &a, const Record &b) { return a.point < b.point; });
        number_of_.reserve(records.size());
        for (const Record &record : records) {
            const bool first = points_.empty() || points_.back() != record.point;
            if (first) {
                points_.push_back(record.point);
                first_id_.push_back(record.id);
            }
            if (!number_of_.emplace(record.id, std::uint32_t(points_.size() - 1)).second)
                throw std::runtime_error(path + ": id " + std::to_string(record.id) +
                                         " is not unique");
        }
    }

    /// Points read, equal ones included.
    std::size_t count() const { return count_; }
    const Points<D> &points() const { return points_; }
    /// The id of the first point in the file that is equal to this one.
    std::int64_t first_id(std::uint32_t number) const { return first_id_[number]; }

    std::uint32_t number_of(std::int64_t id) const {
        const auto found = number_of_.find(id);
        return found == number_of_.end() ? unknown : found->second;
    }

private:
    std::size_t count_ = 0;
    Points<D> points_;
    std::vector<std::int64_t> first_id_;
    std::unordered_map<std::int64_t, std::uint32_t> number_of_;
};

/// A simplex as numbers of distinct points, in a canonical order: ascending, except that the last
/// two are exchanged if that keeps the orientation.
template <int D> using Simplex = std::array<std::uint32_t, D + 1>;

template <int D> Simplex<D> canonical(Simplex<D> simplex) {
    bool odd = false;
    for (int i = 1; i <= D; ++i)
        for (int j = i; j > 0 && simplex[j - 1] > simplex[j]; --j) {
            std::swap(simplex[j - 1], simplex[j]);
            odd = !odd;
        }
    if (odd) std::swap(simplex[D - 1], simplex[D]);
    return simplex;
}

} // namespace abacus::oracle
