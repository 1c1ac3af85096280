// Arrays in the host's memory: what they hold survives growth, and memory comes before it is used.
#include "host/arena.hpp"
#include "support/memory_host.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <cstdint>

namespace abacus::test {
namespace {

template <class T> class Arrays : public testing::Test {};
using Elements = testing::Types<std::uint8_t, std::uint64_t, std::array<std::uint64_t, 5>,
                                std::array<char, 100000>>;
TYPED_TEST_SUITE(Arrays, Elements);

template <class T> T element(std::size_t i) {
    T value{};
    if constexpr (std::is_integral_v<T>)
        value = static_cast<T>(i * 0x9e3779b97f4a7c15);
    else
        value.back() = static_cast<typename T::value_type>(i * 0x9e3779b97f4a7c15);
    return value;
}

TYPED_TEST(Arrays, KeepWhatTheyHoldAsTheyGrow) {
    MemoryHost memory;
    const Host host = memory.host();
    const std::size_t n = (std::size_t{3} << 20) / sizeof(TypeParam) + 3;
    Arena<TypeParam> arena(host);
    while (arena.size() < n) {
        const std::size_t some = std::min<std::size_t>(n - arena.size(), 1 + arena.size() / 7);
        const std::size_t first = arena.size();
        TypeParam *const added = arena.extend(some);
        ASSERT_EQ(added, &arena[first]);
        for (std::size_t i = 0; i < some; ++i) added[i] = element<TypeParam>(first + i);
        ASSERT_GE(arena.capacity(), arena.size());
    }
    arena.reserve(2 * n); // which moves it
    arena.push_back(element<TypeParam>(n));
    Arena<TypeParam> moved(std::move(arena));
    for (std::size_t i = 0; i <= n; ++i) ASSERT_EQ(moved[i], element<TypeParam>(i)) << i;
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(moved.data()) % cache_line, 0u);

    moved.clear();
    moved.resize(n + 1);
    EXPECT_EQ(moved[n], element<TypeParam>(n)); // nothing was given back
    moved.reset();
    EXPECT_EQ(moved.capacity(), 0u);
    EXPECT_EQ(memory.bytes, 0u);
    moved.resize(1);
    moved[0] = element<TypeParam>(1);
    EXPECT_EQ(moved.back(), element<TypeParam>(1));
}

TEST(Populate, ChangesNoBytesAndNoErrno) {
    MemoryHost memory;
    const Host host = memory.host();
    Arena<std::uint8_t> bytes(host);
    bytes.resize(100000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i % 251);
    errno = E2BIG;
    abacus_populate(bytes.data() + 1, 99998);
    abacus_populate(nullptr, 1); // which has no memory
    EXPECT_EQ(errno, E2BIG);
    for (std::size_t i = 0; i < bytes.size(); ++i) ASSERT_EQ(bytes[i], i % 251);
}

} // namespace
} // namespace abacus::test
