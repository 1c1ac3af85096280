// The header row of a mesh, as bytes.
#include <abacus/mesh_header.h>
#include <abacus/regions.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

abacus_header full_header(unsigned attributes) {
    abacus_header header{};
    header.facts.form.dimension = 3;
    header.facts.columns.attributes = attributes;
    header.facts.form.has_domain = 1;
    for (int i = 0; i < ABACUS_MAX_DIMENSION; ++i) {
        header.facts.form.lower[i] = -1.7e308 / (i + 1);
        header.facts.form.upper[i] = 5e-324 * i;
    }
    header.stamp = UINT64_MAX;
    header.facts.census.outside = 7;
    header.facts.census.staged = 1000;
    header.facts.census.inserted = 900;
    header.facts.census.vertices = 800;
    header.facts.census.duplicates = 100;
    header.facts.census.serials = 110;
    header.facts.census.simplices = 4000;
    header.facts.census.ghosts = 90;
    header.counters.insertions = 1;
    header.counters.removals = 2;
    header.counters.peak_bytes = UINT64_MAX;
    for (unsigned i = 0; i < attributes; ++i)
        std::strcpy(header.names[i], ("attribute " + std::to_string(i)).c_str());
    return header;
}

std::vector<unsigned char> encode(const abacus_header &header) {
    std::vector<unsigned char> bytes(ABACUS_PAGE_BYTES);
    bytes.resize(abacus_header_encode(&header, bytes.data()));
    return bytes;
}

/// True if the bytes are accepted; otherwise checks that they are properly refused.
bool decodes(const std::vector<unsigned char> &bytes, abacus_header *header = nullptr) {
    abacus_header decoded;
    abacus_error error{};
    // A copy of exactly this size, so that a sanitizer sees any read beyond it.
    const std::vector<unsigned char> copy(bytes);
    const abacus_status status =
        abacus_header_decode(copy.data(), copy.size(), header ? header : &decoded, &error);
    if (status == ABACUS_OK) return true;
    EXPECT_EQ(status, ABACUS_ERROR);
    const bool newer = error.kind == ABACUS_ERROR_STATE;
    EXPECT_TRUE(newer || error.kind == ABACUS_ERROR_CORRUPTED);
    const std::string message = error.message;
    EXPECT_EQ(message.starts_with("mesh is stored in format ") ||
                  message.find(" has type ") != std::string::npos,
              newer);
    EXPECT_NE((newer ? error.hint : error.detail)[0], '\0');
    return false;
}

TEST(Header, HasATypeForEachColumn) {
    abacus_header header = full_header(3);
    const auto doubles = encode(header);
    header.types[2] = 1;
    const auto other = encode(header);
    ASSERT_EQ(doubles.size(), other.size());
    EXPECT_TRUE(decodes(doubles));
    abacus_header decoded;
    abacus_error error{};
    EXPECT_EQ(abacus_header_decode(other.data(), other.size(), &decoded, &error), ABACUS_ERROR);
    EXPECT_EQ(error.kind, ABACUS_ERROR_STATE);
    EXPECT_STREQ(error.message, "attribute 3 has type 1, but this version of Abacus reads type 0 "
                                "(double precision)");
    EXPECT_STREQ(error.hint, "Use the version that wrote it, or a later one.");
}

TEST(Header, ComesBackAsItWas) {
    for (const unsigned attributes : {0u, 1u, unsigned{ABACUS_MAX_PAGE_ATTRIBUTES}}) {
        const abacus_header header = full_header(attributes);
        const auto bytes = encode(header);
        EXPECT_LE(bytes.size(), std::size_t{ABACUS_PAGE_BYTES});
        abacus_header decoded;
        std::memset(static_cast<void *>(&decoded), 0xff, sizeof decoded);
        ASSERT_TRUE(decodes(bytes, &decoded));
        EXPECT_EQ(encode(decoded), bytes);
        EXPECT_EQ(decoded.facts.form.lower[2], header.facts.form.lower[2]);
        EXPECT_EQ(decoded.facts.census.simplices, header.facts.census.simplices);
        EXPECT_EQ(decoded.counters.peak_bytes, UINT64_MAX);
        for (unsigned i = 0; i < attributes; ++i)
            EXPECT_EQ(decoded.names[i], "attribute " + std::to_string(i));
    }
}

TEST(Header, KeepsTheSridBehindTheNames) {
    for (const unsigned attributes : {0u, 2u, unsigned{ABACUS_MAX_PAGE_ATTRIBUTES}}) {
        abacus_header header = full_header(attributes);
        const auto without = encode(header);
        for (const std::uint32_t srid : {1u, 4326u, unsigned{ABACUS_MAX_SRID}}) {
            header.facts.form.srid = srid;
            const auto bytes = encode(header);
            EXPECT_LE(bytes.size(), std::size_t{ABACUS_PAGE_BYTES});
            // One word longer than a header without SRID, which has not changed.
            ASSERT_EQ(bytes.size(), without.size() + 8);
            EXPECT_TRUE(std::equal(without.begin(), without.end(), bytes.begin()));
            abacus_header decoded;
            ASSERT_TRUE(decodes(bytes, &decoded));
            EXPECT_EQ(decoded.facts.form.srid, srid);
            EXPECT_EQ(encode(decoded), bytes);
        }
    }
}

TEST(Header, AWrongSridIsRefused) {
    auto bytes = encode(full_header(1));
    bytes.resize(bytes.size() + 8); // 0 is not written
    EXPECT_FALSE(decodes(bytes));
    const std::size_t srid = bytes.size() - 8;
    bytes[srid] = 1;
    EXPECT_TRUE(decodes(bytes));
    auto longer = bytes;
    longer.resize(longer.size() + 8);
    EXPECT_FALSE(decodes(longer));
    bytes[srid + 2] = 0x10; // beyond the greatest SRID
    EXPECT_FALSE(decodes(bytes));
    bytes[srid + 2] = 0;
    bytes[srid + 4] = 1;
    EXPECT_FALSE(decodes(bytes));
    for (int cut = 1; cut < 8; ++cut) {
        auto shorter = bytes;
        shorter.resize(bytes.size() - cut);
        EXPECT_FALSE(decodes(shorter));
    }
}

/// Labels and markers come with a format of their own.
TEST(Header, OfLabelsAndMarkers) {
    for (const unsigned attributes : {0u, 5u, unsigned{ABACUS_MAX_PAGE_ATTRIBUTES}})
        for (const unsigned labels : {0u, 1u, ABACUS_HEADER_NAMES - attributes})
            for (const std::uint32_t srid : {0u, 4326u}) {
                abacus_header header = full_header(attributes);
                const auto without = encode(header);
                header.facts.columns.labels = labels;
                header.facts.census.labelled = labels == 0 ? 0 : 4000;
                header.facts.census.marked = labels == 0 ? 1 : 0;
                header.facts.columns.inherits = labels > 1;
                header.facts.columns.apart = attributes > 4;
                header.facts.form.srid = srid;
                for (unsigned i = 0; i < labels; ++i)
                    std::strcpy(header.names[attributes + i],
                                ("label " + std::to_string(i)).c_str());
                const auto bytes = encode(header);
                EXPECT_LE(bytes.size(), std::size_t{ABACUS_PAGE_BYTES});
                EXPECT_EQ(bytes[6], 5);
                abacus_header decoded;
                std::memset(static_cast<void *>(&decoded), 0xff, sizeof decoded);
                ASSERT_TRUE(decodes(bytes, &decoded));
                EXPECT_EQ(encode(decoded), bytes);
                EXPECT_EQ(decoded.facts.columns.apart, header.facts.columns.apart);
                EXPECT_EQ(decoded.facts.form.srid, srid);
                EXPECT_EQ(decoded.facts.columns.labels, labels);
                EXPECT_EQ(decoded.facts.census.labelled, header.facts.census.labelled);
                EXPECT_EQ(decoded.facts.census.marked, header.facts.census.marked);
                EXPECT_EQ(decoded.facts.columns.inherits, header.facts.columns.inherits);
                if (labels > 0) {
                    EXPECT_STREQ(decoded.names[attributes], "label 0");
                }
                // Without them the header has not changed.
                header.facts.columns.labels = 0;
                header.facts.census.labelled = header.facts.census.marked = 0;
                header.facts.columns.inherits = 0;
                header.facts.columns.apart = 0;
                header.facts.form.srid = 0;
                EXPECT_EQ(encode(header), without);
            }
}

/// The header and the rows of names.
std::vector<std::vector<unsigned char>> encode_rows(const abacus_header &header) {
    std::vector<std::vector<unsigned char>> rows{encode(header)};
    for (std::uint32_t row = 0; row < abacus_header_name_rows(&header.facts.columns); ++row) {
        auto &bytes = rows.emplace_back(ABACUS_PAGE_BYTES);
        bytes.resize(abacus_header_encode_names(&header, row, bytes.data()));
    }
    return rows;
}

bool decodes_rows(const std::vector<std::vector<unsigned char>> &rows, abacus_header &header) {
    if (!decodes(rows[0], &header)) return false;
    EXPECT_EQ(abacus_header_name_rows(&header.facts.columns), rows.size() - 1);
    for (std::uint32_t row = 0; row + 1 < rows.size(); ++row) {
        abacus_error error{};
        const std::vector<unsigned char> copy(rows[row + 1]);
        if (abacus_header_decode_names(copy.data(), copy.size(), row, &header, &error) == ABACUS_OK)
            continue;
        EXPECT_EQ(error.kind, ABACUS_ERROR_CORRUPTED);
        return false;
    }
    return true;
}

abacus_header wide_header(unsigned attributes, unsigned labels) {
    abacus_header header = full_header(attributes);
    header.facts.columns.apart = 1;
    header.facts.columns.labels = labels;
    for (unsigned i = 0; i < labels; ++i)
        std::strcpy(header.names[attributes + i], ("label " + std::to_string(i)).c_str());
    return header;
}

/// Many names are in rows of their own, which come with a format of their own.
TEST(Header, OfManyNames) {
    struct Case {
        unsigned attributes, labels, rows;
    };
    for (const auto &[attributes, labels, rows] :
         {Case{100, 15, 0}, Case{101, 0, 1}, Case{100, 16, 1}, Case{1, ABACUS_MAX_LABELS, 1},
          Case{124, 0, 1}, Case{125, 0, 2}, Case{ABACUS_MAX_ATTRIBUTES, 0, 9},
          Case{ABACUS_MAX_ATTRIBUTES, ABACUS_MAX_LABELS, 9}})
        for (const std::uint32_t srid : {0u, 4326u}) {
            abacus_header header = wide_header(attributes, labels);
            header.facts.form.srid = srid;
            const auto bytes = encode_rows(header);
            ASSERT_EQ(bytes.size(), rows + 1);
            EXPECT_EQ(bytes[0][6], rows > 0 ? 6 : 5);
            abacus_header decoded;
            std::memset(static_cast<void *>(&decoded), 0xff, sizeof decoded);
            ASSERT_TRUE(decodes_rows(bytes, decoded));
            EXPECT_EQ(encode_rows(decoded), bytes);
            EXPECT_EQ(decoded.facts.form.srid, srid);
            EXPECT_EQ(decoded.facts.columns.apart, 1u);
            EXPECT_EQ(decoded.facts.columns.labels, labels);
            const std::string last = "attribute " + std::to_string(attributes - 1);
            EXPECT_EQ(decoded.names[attributes - 1], last);
        }
}

TEST(Header, WrongRowsOfNamesAreRefused) {
    abacus_header decoded;
    const auto refuses = [&](unsigned attributes, unsigned labels, auto change) {
        abacus_header header = wide_header(attributes, labels);
        change(header);
        return !decodes_rows(encode_rows(header), decoded);
    };
    EXPECT_FALSE(refuses(500, 2, [](abacus_header &) {}));
    EXPECT_TRUE(refuses(500, 2, [](abacus_header &h) { h.facts.columns.apart = 0; }));
    EXPECT_TRUE(refuses(500, 2, [](abacus_header &h) { h.names[499][0] = 0; }));
    EXPECT_TRUE(refuses(500, 2, [](abacus_header &h) { h.names[501][0] = 0; }));
    EXPECT_TRUE(refuses(500, 0, [](abacus_header &h) { h.facts.census.labelled = 1; }));
    EXPECT_TRUE(refuses(500, 2, [](abacus_header &h) { h.facts.form.srid = ABACUS_MAX_SRID + 1; }));
    const auto rows = encode_rows(wide_header(500, 2));
    for (std::size_t row = 0; row < rows.size(); ++row) {
        auto changed = rows;
        changed[row].pop_back();
        EXPECT_FALSE(decodes_rows(changed, decoded));
        changed[row].resize(rows[row].size() + 8);
        EXPECT_FALSE(decodes_rows(changed, decoded));
    }
    // Invalid counts of attributes and labels: too many, or few enough for the header row.
    constexpr std::size_t attributes = 16;
    const std::size_t labels = rows[0].size() - 40;
    for (const unsigned count : {0u, 100u, 1001u}) {
        auto changed = rows;
        changed[0][attributes] = static_cast<unsigned char>(count & 255);
        changed[0][attributes + 1] = static_cast<unsigned char>(count >> 8);
        EXPECT_FALSE(decodes(changed[0]));
    }
    auto changed = rows;
    changed[0][labels] = ABACUS_MAX_LABELS;
    EXPECT_TRUE(decodes(changed[0]));
    changed[0][labels] = ABACUS_MAX_LABELS + 1;
    EXPECT_FALSE(decodes(changed[0]));
}

TEST(Header, WrongCountsOfLabelsAreRefused) {
    abacus_header header = full_header(5);
    header.facts.columns.labels = 2;
    header.facts.census.labelled = 17;
    std::strcpy(header.names[5], "material");
    std::strcpy(header.names[6], "age");
    const auto accepts = [&](auto change) {
        abacus_header changed = header;
        change(changed);
        return decodes(encode(changed));
    };
    EXPECT_TRUE(accepts([](abacus_header &) {}));
    EXPECT_TRUE(
        accepts([](abacus_header &h) { h.facts.census.labelled = h.facts.census.simplices; }));
    EXPECT_FALSE(accepts([](abacus_header &h) { h.facts.census.labelled = UINT64_MAX; }));
    EXPECT_FALSE(accepts([](abacus_header &h) { h.facts.columns.apart = 2; }));
    EXPECT_FALSE(accepts([](abacus_header &h) { h.facts.form.srid = ABACUS_MAX_SRID + 1; }));
    EXPECT_FALSE(accepts([](abacus_header &h) { h.facts.census.marked = UINT64_MAX; }));
    EXPECT_FALSE(accepts([](abacus_header &h) { h.names[6][0] = 0; }));
    EXPECT_FALSE(
        accepts([](abacus_header &h) { h.facts.columns.labels = 0, h.facts.census.marked = 1; }));
    EXPECT_FALSE(accepts(
        [](abacus_header &h) { h.facts.columns.attributes = 0, h.facts.columns.apart = 1; }));
    const auto bytes = encode(header);
    for (std::size_t cut = 1; cut <= 2 * ABACUS_NAME_BYTES + 40; ++cut) {
        auto shorter = bytes;
        shorter.resize(bytes.size() - cut);
        EXPECT_FALSE(decodes(shorter));
    }
    auto longer = bytes;
    longer.resize(longer.size() + 8);
    EXPECT_FALSE(decodes(longer));
}

TEST(Header, OfAnEmptyMesh) {
    abacus_header header{};
    header.facts.form.dimension = 2;
    EXPECT_TRUE(decodes(encode(header)));
    // Unused bounds are not kept.
    header.facts.form.lower[0] = header.facts.form.upper[2] =
        std::numeric_limits<double>::quiet_NaN();
    abacus_header decoded;
    ASSERT_TRUE(decodes(encode(header), &decoded));
    EXPECT_EQ(decoded.facts.form.lower[0], 0);
    EXPECT_EQ(decoded.facts.form.upper[2], 0);
}

TEST(Header, OfAMeshFromBeforeThreadsWereCounted) {
    for (const unsigned attributes : {0u, 1u, unsigned{ABACUS_MAX_PAGE_ATTRIBUTES}}) {
        abacus_header header = full_header(attributes);
        const auto before = encode(header);
        header.counters.passes = 1;
        header.counters.put_off = 2;
        header.counters.waited_ns = 3;
        auto bytes = encode(header);
        abacus_header decoded;
        ASSERT_TRUE(decodes(bytes, &decoded));
        EXPECT_EQ(decoded.counters.waited_ns, 3u);
        const auto names = bytes.end() - attributes * ABACUS_NAME_BYTES;
        bytes.erase(names - 24, names); // as it was written then
        ASSERT_TRUE(decodes(bytes, &decoded));
        EXPECT_EQ(decoded.counters.peak_bytes, UINT64_MAX);
        EXPECT_EQ(encode(decoded), before);
    }
}

TEST(Header, OfAnOctreeComesBackAsItWas) {
    abacus_header header{};
    header.facts.form.type = ABACUS_OCTREE;
    header.facts.form.dimension = 3;
    header.facts.columns.attributes = 2;
    header.facts.form.levels = 21;
    header.facts.census.leaves = 15;
    header.stamp = UINT64_MAX;
    header.counters.peak_bytes = 12345;
    for (int i = 0; i < 3; ++i) header.facts.form.upper[i] = i + 1;
    std::strcpy(header.names[0], "vs");
    std::strcpy(header.names[1], "vp");
    const auto bytes = encode(header);
    abacus_header decoded;
    ASSERT_TRUE(decodes(bytes, &decoded));
    EXPECT_EQ(encode(decoded), bytes);
    EXPECT_EQ(decoded.facts.form.type, unsigned{ABACUS_OCTREE});
    EXPECT_EQ(decoded.facts.census.leaves, 15u);
    EXPECT_EQ(decoded.facts.form.upper[2], 3);
    EXPECT_STREQ(decoded.names[1], "vp");

    const auto refused = [&](auto change) {
        abacus_header changed = header;
        change(changed);
        return !decodes(encode(changed));
    };
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.levels = 22; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.leaves = 0; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.upper[1] = h.facts.form.lower[1]; }));
    EXPECT_TRUE(refused(
        [](abacus_header &h) { h.facts.form.lower[0] = -1e308, h.facts.form.upper[0] = 1e308; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.dimension = 4; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.names[0][0] = 0; }));
    auto shorter = bytes;
    shorter.pop_back();
    EXPECT_FALSE(decodes(shorter));
}

TEST(Header, AnotherFormatIsSaid) {
    auto bytes = encode(full_header(1));
    ASSERT_EQ(std::string(bytes.begin(), bytes.begin() + 6), "ABACUS");
    abacus_header header;
    abacus_error error{};
    const unsigned format = bytes[6] + 256u * bytes[7];
    for (const unsigned other : {format - 1, format + 7, 0xffffu}) {
        bytes[6] = static_cast<unsigned char>(other);
        bytes[7] = static_cast<unsigned char>(other >> 8);
        ASSERT_EQ(abacus_header_decode(bytes.data(), bytes.size(), &header, &error), ABACUS_ERROR);
        EXPECT_EQ(error.kind, ABACUS_ERROR_STATE);
        EXPECT_EQ(error.message, "mesh is stored in format " + std::to_string(other) +
                                     ", but this version of Abacus reads formats 3 to 9");
    }
    bytes[5] ^= 1;
    ASSERT_EQ(abacus_header_decode(bytes.data(), bytes.size(), &header, &error), ABACUS_ERROR);
    EXPECT_EQ(error.kind, ABACUS_ERROR_CORRUPTED);
}

TEST(Header, TheFormatTellsWhereAttributesAre) {
    for (const bool apart : {false, true}) {
        abacus_header header = full_header(2), decoded;
        header.facts.columns.apart = apart;
        const auto bytes = encode(header);
        EXPECT_EQ(bytes[6], apart ? 4 : 3);
        ASSERT_TRUE(decodes(bytes, &decoded));
        EXPECT_EQ(decoded.facts.columns.apart, header.facts.columns.apart);
    }
    abacus_header header = full_header(0);
    header.facts.columns.apart = 1;
    EXPECT_FALSE(decodes(encode(header)));
}

TEST(Header, OfVerticesThatShareTheirPlaces) {
    abacus_header header = full_header(2);
    header.facts.standing = ABACUS_NOT_CONVEX;
    header.facts.census.staged = header.facts.census.inserted = header.facts.census.vertices;
    header.facts.census.serials = header.facts.census.duplicates = 0;
    EXPECT_EQ(encode(header)[6], 3);
    header.facts.census.split = 2;
    for (const bool marked : {false, true}) {
        header.facts.census.marked = marked ? 3 : 0;
        const auto bytes = encode(header);
        EXPECT_EQ(bytes[6], 6);
        abacus_header decoded;
        ASSERT_TRUE(decodes(bytes, &decoded));
        EXPECT_EQ(decoded.facts.census.split, 2u);
        EXPECT_EQ(decoded.facts.census.marked, header.facts.census.marked);
        EXPECT_EQ(encode(decoded), bytes);
    }
    const auto refused = [&](auto change) {
        abacus_header changed = header;
        change(changed);
        return !decodes(encode(changed));
    };
    // Also with many names.
    header.facts.columns.attributes = 100;
    header.facts.columns.labels = 20;
    for (unsigned i = 0; i < 120; ++i)
        std::strcpy(header.names[i], ("name " + std::to_string(i)).c_str());
    const auto rows = encode_rows(header);
    EXPECT_EQ(rows.size(), 2u);
    abacus_header decoded;
    ASSERT_TRUE(decodes_rows(rows, decoded));
    EXPECT_EQ(decoded.facts.census.split, 2u);
    EXPECT_EQ(encode_rows(decoded), rows);
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.columns.attributes = 101; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.split = 1; }));
    EXPECT_TRUE(
        refused([](abacus_header &h) { h.facts.census.split = h.facts.census.vertices + 1; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.columns.apart = 1; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.standing = ABACUS_DELAUNAY; }));
}

TEST(Header, EveryTruncationIsRefused) {
    auto bytes = encode(full_header(3));
    auto longer = bytes;
    longer.push_back(0);
    EXPECT_FALSE(decodes(longer));
    while (!bytes.empty()) {
        bytes.pop_back();
        EXPECT_FALSE(decodes(bytes));
    }
}

TEST(Header, ContradictionsAreRefused) {
    const auto refused = [](auto change) {
        abacus_header header = full_header(1);
        change(header);
        return !decodes(encode(header));
    };
    EXPECT_FALSE(refused([](abacus_header &) {}));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.dimension = 1; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.dimension = 4; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.has_domain = 2; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.has_domain = 0; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.upper[1] = -1.7e308; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.form.lower[1] = std::nan(""); }));
    EXPECT_TRUE(refused(
        [](abacus_header &h) { h.facts.form.upper[0] = std::numeric_limits<double>::infinity(); }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.inserted = 1001; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.staged = std::uint64_t{1} << 62; }));
    EXPECT_FALSE(refused([](abacus_header &h) {
        h.facts.census.simplices = h.facts.census.ghosts = (std::uint64_t{1} << 62) - 1;
    }));
    EXPECT_TRUE(
        refused([](abacus_header &h) { h.facts.census.simplices = std::uint64_t{1} << 62; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.ghosts = std::uint64_t{1} << 62; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.duplicates = 111; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.serials = 99; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.serials = UINT64_MAX; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.vertices = UINT64_MAX; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.vertices = 0; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.facts.census.simplices = 0; }));
    EXPECT_TRUE(refused([](abacus_header &h) { h.names[0][0] = '\0'; }));
}

TEST(Header, OfAMeshThatIsNotDelaunay) {
    const auto taken = [](auto change) {
        abacus_header header = full_header(1);
        header.facts.standing = 1;
        header.facts.census.staged = header.facts.census.inserted = header.facts.census.vertices;
        header.facts.census.duplicates = header.facts.census.serials = 0;
        change(header);
        abacus_header decoded;
        return decodes(encode(header), &decoded) && decoded.facts.standing == header.facts.standing;
    };
    for (const std::uint32_t why : {ABACUS_NOT_DELAUNAY, ABACUS_WEAKLY_DELAUNAY, ABACUS_NOT_CONVEX})
        EXPECT_TRUE(taken([&](abacus_header &h) { h.facts.standing = why; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.standing = ABACUS_CONSTRAINED + 1; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.census.inserted = 0; }));
    EXPECT_FALSE(taken([](abacus_header &h) { ++h.facts.census.staged; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.census.serials = 1; }));
    EXPECT_FALSE(taken([](abacus_header &h) {
        h.facts.census.staged = h.facts.census.inserted = h.facts.census.vertices =
            h.facts.census.simplices = h.facts.census.ghosts = 0;
    }));
}

TEST(Header, OfAMeshWithLines) {
    const auto taken = [](auto change) {
        abacus_header header = full_header(1);
        header.facts.form.dimension = 2;
        header.facts.standing = ABACUS_CONSTRAINED;
        header.facts.census.lines = 3;
        change(header);
        abacus_header decoded;
        return decodes(encode(header), &decoded) &&
               decoded.facts.standing == header.facts.standing &&
               decoded.facts.census.lines == header.facts.census.lines &&
               decoded.facts.census.lines_wait == header.facts.census.lines_wait;
    };
    EXPECT_TRUE(taken([](abacus_header &) {}));
    EXPECT_TRUE(taken([](abacus_header &h) { h.facts.census.lines_wait = 1; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.census.lines_wait = 2; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.census.lines = 0; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.census.lines = UINT64_MAX; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.form.dimension = 3; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.standing = ABACUS_DELAUNAY; }));
}

TEST(Header, OfAMeshWithRegions) {
    const auto taken = [](auto change) {
        abacus_header header = full_header(1);
        header.facts.form.dimension = 2;
        header.facts.standing = ABACUS_CONSTRAINED;
        header.facts.census.lines = 3;
        header.facts.census.regions = 2;
        header.facts.census.seeded = 1;
        change(header);
        abacus_header decoded;
        return decodes(encode(header), &decoded) &&
               decoded.facts.census.regions == header.facts.census.regions &&
               decoded.facts.census.seeded == header.facts.census.seeded;
    };
    EXPECT_TRUE(taken([](abacus_header &) {}));
    EXPECT_TRUE(taken([](abacus_header &h) { h.facts.census.regions = ABACUS_MAX_REGIONS; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.census.regions = ABACUS_MAX_REGIONS + 1; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.census.seeded = 3; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.census.lines = 0; }));
    EXPECT_FALSE(taken([](abacus_header &h) { h.facts.standing = ABACUS_DELAUNAY; }));
}

TEST(Header, OfAMeshWithLinesKeepsTheGreatestId) {
    for (const std::int64_t id : {INT64_MIN, std::int64_t{-1}, std::int64_t{7}, INT64_MAX})
        for (const std::uint64_t regions : {0, 2}) {
            abacus_header header = full_header(1), decoded;
            header.facts.form.dimension = 2;
            header.facts.standing = ABACUS_CONSTRAINED;
            header.facts.census.lines = 3;
            header.facts.census.regions = regions;
            header.facts.census.knows_ids = 1;
            header.facts.census.greatest_id = id;
            ASSERT_TRUE(decodes(encode(header), &decoded));
            EXPECT_EQ(decoded.facts.census.knows_ids, 1u);
            EXPECT_EQ(decoded.facts.census.greatest_id, id);
            EXPECT_EQ(decoded.facts.census.regions, regions);
            header.facts.census.knows_ids = 0; // as those that have been stored before
            ASSERT_TRUE(decodes(encode(header), &decoded));
            EXPECT_EQ(decoded.facts.census.knows_ids, 0u);
        }
    abacus_header header = full_header(1), decoded; // without lines it is not kept
    header.facts.census.knows_ids = 1;
    ASSERT_TRUE(decodes(encode(header), &decoded));
    EXPECT_EQ(decoded.facts.census.knows_ids, 0u);
}

TEST(Header, DamagedBytesNeverCrash) {
    const auto sound = encode(full_header(2));
    for (std::size_t byte = 0; byte < sound.size(); ++byte) {
        auto bytes = sound;
        for (const unsigned char value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
            bytes[byte] = value;
            decodes(bytes);
        }
    }
    std::mt19937 random(1);
    for (int round = 0; round < 20000; ++round) {
        auto bytes = sound;
        for (int i = 0; i < 4; ++i)
            bytes[random() % bytes.size()] = static_cast<unsigned char>(random());
        decodes(bytes);
    }
    // A name that fills its room is not zero-terminated.
    auto bytes = sound;
    std::fill(bytes.end() - ABACUS_NAME_BYTES, bytes.end(), 'x');
    EXPECT_FALSE(decodes(bytes));
}

} // namespace
