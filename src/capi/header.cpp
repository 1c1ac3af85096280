// The header row of a mesh as bytes: little-endian, fixed fields, then the names of the attributes
// with their types, and last the SRID if there is one. If simplices have labels or facets have
// markers, the SRID is always there, and the facts about labels and markers follow. Newer features
// have one form: all these words, how many vertices share their places, and then the names, unless
// there are so many that they have rows of their own. A user can write any bytes into these rows,
// so decoding checks every field; it accepts exactly the bytes that encoding can produce.
#include "capi/header_words.hpp"

#include "capi/guard.hpp"

#include <abacus/mesh_header.h>
#include <abacus/octree.h>
#include <abacus/regions.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>

namespace abacus {
namespace {

/// A header begins with the bytes "ABACUS" and the format of the mesh, which covers the header and
/// all its pages. The number is raised when any of them changes. The format alone says whether
/// vertices have their attributes in simplex pages or apart, unless there are labels or markers,
/// vertices that share their places, names in rows of their own, lines, regions, or a greatest id.
constexpr std::uint64_t name = 0x535543414241, format = 3, format_apart = 4, format_labelled = 5,
                        format_extended = 6, format_constrained = 7, format_regions = 8,
                        format_ids = 9;
constexpr int name_bits = 48;
/// The header of an octree begins with the bytes "OCTREE" and a format of its own.
constexpr std::uint64_t octree_name = 0x454552544f43ull, octree_format = 1;
/// Counts and sequence numbers are bigint in the database, and so is the sum of two.
constexpr std::uint64_t count_limit = std::uint64_t{1} << 62;

// The counters are fields of one type without gaps, so they are stored as an array.
constexpr std::size_t counter_count = sizeof(abacus_counters) / sizeof(std::uint64_t);
/// Older headers do not have the last counters.
constexpr std::size_t least_counters = offsetof(abacus_counters, passes) / sizeof(std::uint64_t);

/// The fields of the header in their order in the row, up to the names.
template <class Header, class Visit> void visit_fields(Header &header, Visit &visit) {
    auto &[form, columns, census, standing] = header.facts;
    visit(form.dimension);
    visit(columns.attributes);
    visit(form.has_domain);
    for (auto &value : form.lower) visit(value);
    for (auto &value : form.upper) visit(value);
    visit(census.outside);
    visit(header.stamp);
    visit(census.staged);
    visit(census.inserted);
    visit(census.vertices);
    visit(census.duplicates);
    visit(census.serials);
    visit(census.simplices);
    visit(census.ghosts);
    visit(standing);
}
template <class Header, class Visit> void visit_octree_fields(Header &header, Visit &visit) {
    auto &[form, columns, census, standing] = header.facts;
    visit(form.dimension);
    visit(columns.attributes);
    visit(form.levels);
    for (auto &value : form.lower) visit(value);
    for (auto &value : form.upper) visit(value);
    visit(header.stamp);
    visit(census.leaves);
}

void check_domain(abacus_form &form) {
    if (form.has_domain > 1) throw_corrupted("The header's domain is neither set nor unset.");
    for (unsigned i = 0; i < ABACUS_MAX_DIMENSION; ++i) {
        double &lower = form.lower[i], &upper = form.upper[i];
        if (form.has_domain == 0 || i >= form.dimension) lower = upper = 0;
        if (!std::isfinite(lower) || !std::isfinite(upper) || lower > upper)
            throw_corrupted("The header's domain is not a finite box.");
    }
}

void check_counts(const abacus_facts &facts) {
    const abacus_census &census = facts.census;
    if (census.staged >= count_limit || census.outside >= count_limit ||
        census.inserted > census.staged || census.vertices >= count_limit ||
        census.serials >= count_limit || census.duplicates > census.serials ||
        (census.vertices == 0 && census.duplicates > 0))
        throw_corrupted("The header's counts of points contradict each other.");
    if (facts.standing > ABACUS_CONSTRAINED ||
        (abacus_is_own(facts.standing) == 0 &&
         (census.simplices == 0 || census.staged != census.vertices ||
          census.inserted != census.vertices || census.serials > 0)))
        throw_corrupted("The header's mark of a mesh that is not Delaunay is not valid.");
    if ((census.staged > 0 || census.vertices > 0) && facts.form.has_domain == 0)
        throw_corrupted("The header has points but no domain.");
    if (census.simplices >= count_limit || census.ghosts >= count_limit ||
        (census.vertices == 0 && (census.simplices > 0 || census.ghosts > 0)) ||
        (census.vertices > 0 && (census.simplices == 0 || census.ghosts == 0)))
        throw_corrupted("The header's counts of simplices contradict its count of vertices.");
}

/// The i-th column in words, counted from 1.
std::string column(const abacus_columns &columns, unsigned i) {
    return i < columns.attributes ? "attribute " + std::to_string(i + 1)
                                  : "label " + std::to_string(i - columns.attributes + 1);
}

void read_names(HeaderReader &read, unsigned begin, unsigned end, abacus_header &header) {
    for (unsigned i = begin; i < end; ++i) {
        const char *name = read.text(ABACUS_NAME_BYTES);
        const std::size_t length = strnlen(name, type_byte);
        if (length == 0)
            throw_corrupted("The name of " + column(header.facts.columns, i) + " is not valid.");
        header.types[i] = static_cast<unsigned char>(name[type_byte]);
        if (header.types[i] != ABACUS_FLOAT8)
            throw Error(ABACUS_ERROR_STATE,
                        column(header.facts.columns, i) + " has type " +
                            std::to_string(header.types[i]) +
                            ", but this version of Abacus reads type " +
                            std::to_string(ABACUS_FLOAT8) + " (double precision)",
                        {}, "Use the version that wrote it, or a later one.");
        std::memcpy(header.names[i], name, length);
        std::memset(header.names[i] + length, 0, ABACUS_NAME_BYTES - length);
    }
}

/// A mesh without SRID has no word for it.
void read_srid(HeaderReader &read, abacus_form &form) {
    if (read.left() == 0) return;
    read(form.srid);
    if (form.srid == 0 || form.srid > ABACUS_MAX_SRID)
        throw_corrupted("The header's SRID is out of range.");
    if (read.left() > 0) throw_corrupted("The header is too long.");
}

unsigned names_of(const abacus_columns &columns) { return columns.attributes + columns.labels; }

/// Whether the names are in rows of their own.
bool is_wide(const abacus_columns &columns) {
    return columns.attributes > ABACUS_MAX_PAGE_ATTRIBUTES ||
           names_of(columns) > ABACUS_HEADER_NAMES;
}
/// How many names a row has.
constexpr unsigned names_in_row = ABACUS_PAGE_BYTES / ABACUS_NAME_BYTES;
unsigned first_name(const abacus_columns &columns, unsigned row) {
    return std::min(row * names_in_row, names_of(columns));
}

bool is_labelled(const abacus_facts &facts) {
    return facts.columns.labels > 0 || facts.census.marked > 0;
}

template <class Facts, class Visit> void visit_label_fields(Facts &facts, Visit &visit) {
    auto &[form, columns, census, standing] = facts;
    visit(form.srid);
    visit(columns.apart);
    visit(columns.labels);
    visit(census.labelled);
    visit(census.marked);
    visit(columns.inherits);
}

template <class Census, class Visit> void visit_line_fields(Census &census, Visit &visit) {
    visit(census.lines);
    visit(census.soft_lines);
    visit(census.lines_wait);
}

template <class Census, class Visit> void visit_region_fields(Census &census, Visit &visit) {
    visit(census.regions);
    visit(census.seeded);
}

/// The greatest id as a word without sign.
void visit_id_fields(const abacus_census &census, HeaderWriter &write) {
    write(static_cast<std::uint64_t>(census.greatest_id));
}
void visit_id_fields(abacus_census &census, HeaderReader &read) {
    std::uint64_t id;
    read(id);
    census.greatest_id = static_cast<std::int64_t>(id);
    census.knows_ids = 1;
}
bool has_ids(const abacus_facts &facts) {
    return facts.standing == ABACUS_CONSTRAINED && facts.census.knows_ids != 0;
}

/// Whether the facts need one of the latest formats.
bool is_extended(const abacus_facts &facts) {
    return facts.census.split > 0 || is_wide(facts.columns) || facts.standing == ABACUS_CONSTRAINED;
}

void check_labels(const abacus_facts &facts) {
    const abacus_columns &columns = facts.columns;
    const abacus_census &census = facts.census;
    if (columns.apart > 1 ||
        (columns.apart == 0 && columns.attributes > ABACUS_MAX_PAGE_ATTRIBUTES))
        throw_corrupted("The header's mark of attributes in separate pages is not valid.");
    if (columns.labels > ABACUS_MAX_LABELS || census.labelled > census.simplices ||
        census.marked > census.simplices || (census.labelled > 0 && columns.labels == 0) ||
        columns.inherits > (columns.labels > 0 ? 1u : 0u))
        throw_corrupted("The header's counts of labels and markers contradict the others.");
}

void check_split(const abacus_facts &facts) {
    const abacus_census &census = facts.census;
    if (census.split > 0 && (census.split < 2 || census.split > census.vertices ||
                             abacus_is_own(facts.standing) != 0 || facts.columns.apart != 0))
        throw_corrupted("The header's count of vertices that share their places is not valid.");
}

/// Lines of a constrained mesh, in the header since format 7.
void check_lines(const abacus_facts &facts, bool has_lines) {
    const abacus_census &census = facts.census;
    const bool is_constrained = facts.standing == ABACUS_CONSTRAINED;
    if (is_constrained != has_lines || is_constrained != (census.lines > 0) ||
        census.lines >= count_limit || census.soft_lines > census.lines || census.lines_wait > 1 ||
        (is_constrained &&
         (facts.form.dimension != 2 || (census.vertices == 0 && census.lines_wait == 0))))
        throw_corrupted("The header's count of lines is not valid.");
}

/// Regions, in the header since format 8; format 9 has their counts also if there are none.
void check_regions(const abacus_census &census, bool has_regions, bool has_ids) {
    if ((has_regions != (census.regions > 0) && !has_ids) || census.regions > ABACUS_MAX_REGIONS ||
        census.seeded > census.regions || (has_regions && census.lines == 0))
        throw_corrupted("The header's count of regions is not valid.");
}

/// Labels of simplices, markers of facets, vertices that share their places, lines; then names.
void read_labels(HeaderReader &read, std::uint64_t found, abacus_header &header) {
    const bool extended = found >= format_extended, has_lines = found >= format_constrained,
               has_regions = found >= format_regions, has_ids = found >= format_ids;
    abacus_facts &facts = header.facts;
    visit_label_fields(facts, read);
    if (extended) read(facts.census.split);
    if (has_lines) visit_line_fields(facts.census, read);
    if (has_regions) visit_region_fields(facts.census, read);
    if (has_ids) visit_id_fields(facts.census, read);
    if (facts.form.srid > ABACUS_MAX_SRID) throw_corrupted("The header's SRID is out of range.");
    check_labels(facts);
    check_split(facts);
    check_lines(facts, has_lines);
    check_regions(facts.census, has_regions, has_ids);
    if (is_extended(facts) != extended || !(extended || is_labelled(facts)))
        throw_corrupted("The header's format does not fit its contents.");
    if (is_wide(facts.columns))
        for (unsigned i = 0; i < names_of(facts.columns); ++i) header.names[i][0] = '\0';
    else
        read_names(read, extended ? 0 : facts.columns.attributes, names_of(facts.columns), header);
    if (read.left() > 0) throw_corrupted("The header is too long.");
}

void check_octree(abacus_facts &facts) {
    abacus_form &form = facts.form;
    form.has_domain = 1;
    check_domain(form);
    for (unsigned i = 0; i < form.dimension; ++i)
        if (!(form.lower[i] < form.upper[i]) || !std::isfinite(form.upper[i] - form.lower[i]))
            throw_corrupted("The header's domain is empty.");
    if (form.levels > abacus_octree_levels(form.dimension))
        throw_corrupted("The header has too many levels.");
    if (facts.census.leaves == 0 || facts.census.leaves >= count_limit)
        throw_corrupted("The header's count of leaves is not valid.");
}

void check_octree_format(std::uint64_t found) {
    if (found >> name_bits != octree_format)
        throw Error(ABACUS_ERROR_STATE, "octree is stored in format " +
                                            std::to_string(found >> name_bits) +
                                            ", but this version of Abacus reads format " +
                                            std::to_string(octree_format));
}

std::uint64_t format_of(const abacus_facts &facts) {
    if (has_ids(facts)) return format_ids;
    if (facts.census.regions > 0) return format_regions;
    if (facts.standing == ABACUS_CONSTRAINED) return format_constrained;
    if (is_extended(facts)) return format_extended;
    if (is_labelled(facts)) return format_labelled;
    return facts.columns.apart != 0 ? format_apart : format;
}

bool has_name(std::uint64_t found, std::uint64_t name) {
    return (found ^ name) << (64 - name_bits) == 0;
}

void check_format(std::uint64_t found) {
    if (!has_name(found, name)) throw_corrupted("The row with the lowest key is not a header.");
    if (found >> name_bits < format || found >> name_bits > format_ids)
        throw Error(ABACUS_ERROR_STATE,
                    "mesh is stored in format " + std::to_string(found >> name_bits) +
                        ", but this version of Abacus reads formats " + std::to_string(format) +
                        " to " + std::to_string(format_ids),
                    {},
                    "Read its points with the version that wrote it (abacus_vertices), and build "
                    "it anew.");
}

void decode(const unsigned char *bytes, std::size_t size, abacus_header &header) {
    abacus_facts &facts = header.facts;
    HeaderReader read(bytes, size);
    std::uint64_t found;
    read(found);
    const bool is_octree = has_name(found, octree_name);
    facts.form.type = is_octree ? ABACUS_OCTREE : ABACUS_MESH;
    if (is_octree) {
        check_octree_format(found);
        visit_octree_fields(header, read);
    } else {
        check_format(found);
        facts.columns.apart = found >> name_bits == format_apart;
        visit_fields(header, read);
    }
    if (facts.form.dimension < 2 || facts.form.dimension > ABACUS_MAX_DIMENSION)
        throw_corrupted("The header's dimension is " + std::to_string(facts.form.dimension) + ".");
    const bool extended = !is_octree && found >> name_bits >= format_extended,
               labelled = !is_octree && found >> name_bits >= format_labelled;
    if (facts.columns.attributes > (extended ? ABACUS_MAX_ATTRIBUTES : ABACUS_MAX_PAGE_ATTRIBUTES))
        throw_corrupted("The header has " + std::to_string(facts.columns.attributes) +
                        " attributes.");
    if (is_octree) {
        check_octree(facts);
    } else {
        check_domain(facts.form);
        check_counts(facts);
    }
    std::uint64_t counters[counter_count]{};
    const std::size_t names = facts.columns.attributes * std::size_t{ABACUS_NAME_BYTES};
    const bool has_all = labelled || read.left() >= names + sizeof counters;
    for (std::size_t i = 0; i < (has_all ? counter_count : least_counters); ++i) read(counters[i]);
    std::memcpy(&header.counters, counters, sizeof counters);
    if (!extended) read_names(read, 0, facts.columns.attributes, header);
    if (labelled)
        read_labels(read, found >> name_bits, header);
    else
        read_srid(read, facts.form);
    if (!extended) check_lines(facts, false);
    if (facts.columns.apart != 0 && facts.columns.attributes == 0)
        throw_corrupted("The header has no attributes, but says that they are in separate pages.");
}

/// Decodes a header. An error names the kind of object that the bytes claim to be.
void decode_named(const unsigned char *bytes, std::size_t size, abacus_header &header) {
    try {
        decode(bytes, size, header);
    } catch (const Error &error) {
        if (error.kind != ABACUS_ERROR_CORRUPTED || header.facts.form.type != ABACUS_OCTREE) throw;
        throw_corrupted(error.detail, "octree");
    }
}

} // namespace
} // namespace abacus

uint32_t abacus_are_apart(uint32_t dimension, uint32_t attributes) {
    // Measured in bytes on disk, for points at random, with heights in hundredths and with doubles
    // of all bits: attributes take less room apart from 4 to 6 of them on in the plane, from 2 to 3
    // on in space.
    return attributes > (dimension == 2 ? 4 : 2);
}

size_t abacus_header_encode(const abacus_header *header, unsigned char *bytes) {
    using namespace abacus;
    const abacus_facts &facts = header->facts;
    HeaderWriter write(bytes);
    if (facts.form.type == ABACUS_OCTREE) {
        write(octree_name | octree_format << name_bits);
        visit_octree_fields(*header, write);
    } else {
        write(name | format_of(facts) << name_bits);
        visit_fields(*header, write);
    }
    std::uint64_t counters[counter_count];
    std::memcpy(counters, &header->counters, sizeof counters);
    for (const auto counter : counters) write(counter);
    const bool extended = facts.form.type == ABACUS_MESH && is_extended(facts);
    if (!extended) write.names(*header, 0, facts.columns.attributes);
    if (extended || is_labelled(facts)) {
        visit_label_fields(facts, write);
        if (extended) write(facts.census.split);
        if (facts.standing == ABACUS_CONSTRAINED) visit_line_fields(facts.census, write);
        if (facts.census.regions > 0 || has_ids(facts)) visit_region_fields(facts.census, write);
        if (has_ids(facts)) visit_id_fields(facts.census, write);
        if (!is_wide(facts.columns))
            write.names(*header, extended ? 0 : facts.columns.attributes, names_of(facts.columns));
    } else if (facts.form.srid != 0) {
        write(facts.form.srid);
    }
    return write.size();
}

uint32_t abacus_header_name_rows(const abacus_columns *columns) {
    using namespace abacus;
    return is_wide(*columns) ? (names_of(*columns) + names_in_row - 1) / names_in_row : 0;
}

size_t abacus_header_encode_names(const abacus_header *header, uint32_t row, unsigned char *bytes) {
    using namespace abacus;
    HeaderWriter write(bytes);
    write.names(*header, first_name(header->facts.columns, row),
                first_name(header->facts.columns, row + 1));
    return write.size();
}

abacus_status abacus_header_decode_names(const unsigned char *bytes, size_t size, uint32_t row,
                                         abacus_header *header, abacus_error *error) {
    using namespace abacus;
    return guard(error, [&] {
        const unsigned begin = first_name(header->facts.columns, row),
                       end = first_name(header->facts.columns, row + 1);
        if (size != (end - begin) * std::size_t{ABACUS_NAME_BYTES})
            throw_corrupted("A row of names is missing or does not have the size of its names.");
        HeaderReader read(bytes, size);
        read_names(read, begin, end, *header);
        return ABACUS_OK;
    });
}

abacus_status abacus_header_decode(const unsigned char *bytes, size_t size, abacus_header *header,
                                   abacus_error *error) {
    return abacus::guard(error, [&] {
        abacus_header decoded;
        std::memset(static_cast<void *>(&decoded), 0, offsetof(abacus_header, names));
        abacus::decode_named(bytes, size, decoded);
        *header = decoded;
        return ABACUS_OK;
    });
}
