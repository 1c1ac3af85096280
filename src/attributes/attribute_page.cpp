#include "attributes/attribute_page.hpp"

#include "mesh/page_format.hpp"

#include <algorithm>
#include <compare>
#include <limits>

namespace abacus {

namespace {

void require(bool condition, const char *detail) {
    if (!condition) [[unlikely]]
        throw_corrupted(detail);
}

} // namespace

template <int D, int K>
void AttributePage<D, K>::read(const unsigned char *bytes, std::size_t size, unsigned group,
                               unsigned columns) {
    constexpr const char *wrong_size = "An attribute page's size does not fit its counts.";
    AttributePageHeader header;
    require(size >= sizeof header + checksum_bytes && size <= ABACUS_PAGE_BYTES,
            "An attribute page has an impossible size.");
    std::memcpy(&header, bytes, sizeof header);
    require(header.magic == AttributePageHeader::expected_magic &&
                header.version == AttributePageHeader::expected_version,
            "A page of attributes is not of this format version.");
    require(header.dimension == D && header.group == group && header.columns == columns &&
                columns <= columns_.size() && (K > 1 || header.points == 0),
            "An attribute page belongs to another kind of mesh.");
    require(header.rows <= most_in_attribute_page && header.points <= K * most_in_attribute_page,
            "An attribute page has impossible counts.");
    require(page_is_sealed(bytes, size), "An attribute page has a wrong checksum.");
    const std::size_t rows = header.rows, points = K == 1 ? rows : header.points;
    const unsigned char *at = bytes + sizeof header, *const end = bytes + size - checksum_bytes;
    const auto each_column = [&](auto take) {
        for (Column &axis : axes_) require(take(axis, points), wrong_size);
        for (Column &number : numbers_) require(take(number, rows), wrong_size);
        if (K > 1) require(take(nulls_, rows), wrong_size);
        for (unsigned i = 0; i < columns; ++i) require(take(columns_[i], rows), wrong_size);
    };
    each_column([&](Column &column, std::size_t) { return column.read_head(at, end); });
    each_column([&](Column &column, std::size_t n) { return column.read_deltas(at, end, n); });
    require(at == end, wrong_size);
    rows_ = rows;
    group_ = group;
    check_points(points);
    if (K > 1) check_owners(points, columns);
}

template <int D, int K> void AttributePage<D, K>::check_points(std::size_t points) const {
    constexpr double most = std::numeric_limits<double>::infinity();
    for (const Column &axis : axes_)
        for (std::size_t i = 0; i < points; ++i)
            require(ordered(-most) < axis[i] && axis[i] < ordered(most) && axis[i] != ordered(-0.0),
                    "An attribute page has a coordinate that is not a finite number.");
}

/// Checks the points, the numbers by which rows name them, and which attributes are NULL.
template <int D, int K>
void AttributePage<D, K>::check_owners(std::size_t points, unsigned columns) const {
    for (std::size_t i = 1; i < points; ++i)
        require(point(i - 1) < point(i), "The points of an attribute page are not in order.");
    const std::uint64_t all = (std::uint64_t{1} << columns) - 1;
    for (std::size_t row = 0; row < rows_; ++row) {
        for (int k = 0; k < K; ++k)
            require(numbers_[k][row] < points &&
                        (k == 0 || numbers_[k - 1][row] < numbers_[k][row]),
                    "An attribute page names points that it does not have, or not in order.");
        require(nulls_[row] <= all, "An attribute page has NULL in columns that it does not have.");
    }
}

template <int D, int K>
void AttributePage<D, K>::keys(const Domain<D> &domain, const Key &lower, const Key &upper,
                               Arena<Key> &keys) const {
    keys.resize(rows_);
    for (std::size_t row = 0; row < rows_; ++row) {
        const Owner<D, K> named = owner(row);
        keys[row] = in_group(attribute_key<D, K>(named, code_of<D, K>(domain, named)), group_);
    }
    for (std::size_t row = 0; row < rows_; ++row)
        require(row == 0 ? lower <= keys[row] : keys[row - 1] <= keys[row],
                "An attribute page is not in order.");
    require(rows_ == 0 || keys[rows_ - 1] < upper,
            "An attribute page has attributes that another page owns.");
}

// ---- Writing --------------------------------------------------------------------------

void AttributePageWriter::number_points(const std::uint64_t *rows, std::size_t n) {
    corners_.clear();
    for (std::size_t row = 0; row < n; ++row)
        for (unsigned k = 0; k < points_; ++k)
            corners_.push_back({static_cast<std::uint32_t>(row * stride_ + k * dimension_),
                                static_cast<std::uint32_t>(row * points_ + k)});
    const auto order = [&](const Corner &a, const Corner &b) {
        return std::lexicographical_compare_three_way(rows + a.offset, rows + a.offset + dimension_,
                                                      rows + b.offset,
                                                      rows + b.offset + dimension_);
    };
    std::sort(corners_.begin(), corners_.end(),
              [&](const Corner &a, const Corner &b) { return std::is_lt(order(a, b)); });
    numbers_.resize(corners_.size());
    table_.clear();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        if (i == 0 || std::is_neq(order(corners_[i - 1], corners_[i])))
            std::copy_n(rows + corners_[i].offset, dimension_, table_.extend(dimension_));
        numbers_[corners_[i].place] = points() - 1;
    }
}

/// The words `first`, `first` + stride, ...; if n is 0, `words` may be null.
const std::uint64_t *AttributePageWriter::gather(const std::uint64_t *words, std::size_t first,
                                                 std::size_t n, std::size_t stride) {
    column_.resize(n);
    std::uint64_t *const to = column_.data();
    for (std::size_t i = 0; i < n; ++i) to[i] = words[first + i * stride];
    return to;
}

/// Which attributes of each row are NULL.
const std::uint64_t *AttributePageWriter::gather_nulls(const std::uint64_t *rows, std::size_t n) {
    column_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        std::uint64_t nulls = 0;
        for (unsigned c = 0; c < columns_; ++c)
            nulls |= std::uint64_t{is_null(rows[i * stride_ + dimension_ * points_ + c])} << c;
        column_[i] = nulls;
    }
    return column_.data();
}

/// The values of an attribute, where some other value of it replaces each NULL.
const std::uint64_t *AttributePageWriter::gather_values(const std::uint64_t *rows,
                                                        unsigned attribute, std::size_t n) {
    gather(rows, dimension_ * points_ + attribute, n, stride_);
    std::uint64_t *const begin = column_.begin(), *const end = column_.end();
    const std::uint64_t *const some = std::find_if_not(begin, end, is_null);
    std::replace_if(begin, end, is_null, some == end ? 0 : *some);
    return begin;
}

template <class Visit>
void AttributePageWriter::each_column(const std::uint64_t *rows, std::size_t n,
                                      const Visit &visit) {
    if (points_ == 1) {
        for (unsigned i = 0; i < stride_; ++i) visit(gather(rows, i, n, stride_), n);
        return;
    }
    for (unsigned i = 0; i < dimension_; ++i)
        visit(gather(table_.data(), i, points(), dimension_), points());
    for (unsigned k = 0; k < points_; ++k) visit(gather(numbers_.data(), k, n, points_), n);
    visit(gather_nulls(rows, n), n);
    for (unsigned i = 0; i < columns_; ++i) visit(gather_values(rows, i, n), n);
}

std::size_t AttributePageWriter::size(const std::uint64_t *rows, std::size_t n) {
    if (points_ > 1) number_points(rows, n);
    std::size_t size = sizeof(AttributePageHeader) + checksum_bytes;
    each_column(rows, n, [&](const std::uint64_t *words, std::size_t count) {
        size += ColumnPlan(words, count).size();
    });
    return size;
}

/// The size grows almost linearly with the rows, so a few linear guesses are enough.
std::size_t AttributePageWriter::count_that_fits(const std::uint64_t *rows, std::size_t n) {
    const std::size_t all = std::min(n, most_written_in_attribute_page);
    std::size_t fits = 0, too_many = all + 1, fit_size = sizeof(AttributePageHeader);
    std::size_t guess = all;
    constexpr int guesses = 8;
    for (int i = 0; fits + 1 < too_many && (fits == 0 || i < guesses); ++i) {
        const std::size_t bytes = size(rows, guess);
        if (bytes <= ABACUS_PAGE_BYTES) {
            fits = guess;
            fit_size = bytes;
            if (fits == all) break;
        } else {
            too_many = guess;
        }
        // Assume that one more row takes as much as the rows so far on average.
        const std::size_t each =
            std::max<std::size_t>(1, (bytes - sizeof(AttributePageHeader)) / guess);
        const std::size_t more = (ABACUS_PAGE_BYTES - fit_size) / each;
        guess = std::clamp(fits + more, fits + 1, too_many - 1);
        if (fits > 0 && more == 0) break;
    }
    return fits;
}

void AttributePageWriter::write(const std::uint64_t *rows, std::size_t n) {
    if (points_ > 1) number_points(rows, n);
    const AttributePageHeader header{AttributePageHeader::expected_magic,
                                     AttributePageHeader::expected_version,
                                     static_cast<std::uint8_t>(dimension_),
                                     static_cast<std::uint16_t>(group_),
                                     static_cast<std::uint16_t>(columns_),
                                     static_cast<std::uint16_t>(n),
                                     points_ > 1 ? static_cast<std::uint32_t>(points()) : 0};
    std::memcpy(bytes_, &header, sizeof header);
    unsigned char *at = bytes_ + sizeof header;
    // The points axis by axis, the numbers of each row's points, which values are NULL, attributes.
    constexpr unsigned most_named = 2 * ABACUS_MAX_DIMENSION + 2;
    std::array<ColumnPlan, most_named + AttributeGroups::widest> plans;
    ColumnPlan *plan = plans.data();
    each_column(rows, n, [&](const std::uint64_t *words, std::size_t count) {
        *plan = ColumnPlan(words, count);
        at = plan++->write_head(at);
    });
    plan = plans.data();
    each_column(rows, n, [&](const std::uint64_t *words, std::size_t) {
        at = plan++->write_deltas(words, at);
    });
    size_ = static_cast<std::size_t>(at - bytes_) + checksum_bytes;
    seal_page(bytes_, size_);
}

template class AttributePage<2>;
template class AttributePage<3>;
template class AttributePage<2, 3>;
template class AttributePage<3, 4>;

} // namespace abacus
