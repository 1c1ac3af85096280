// write_laz IN.las OUT.laz N [N ...]: compresses a LAS file with laz-perf's writer
// (github.com/hobuinc/laz-perf), in chunks of N points, or of the numbers of points that are given.
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <lazperf/header.hpp>
#include <lazperf/lazperf.hpp>
#include <lazperf/writers.hpp>
#include <string>

int main(int arguments, char **texts) {
    std::ifstream in(texts[1], std::ios::binary);
    const std::string data((std::istreambuf_iterator<char>(in)), {});
    const auto number = [&data](std::size_t at, auto value) {
        std::memcpy(&value, &data[at], sizeof(value));
        return value;
    };
    const std::size_t length = number(105, std::uint16_t{});
    const auto vector = [&number](std::size_t at) {
        return lazperf::vector3(number(at, double{}), number(at + 8, double{}),
                                number(at + 16, double{}));
    };

    lazperf::writer::named_file::config config(vector(131), vector(155));
    config.chunk_size =
        arguments > 4 ? lazperf::VariableChunkSize : static_cast<unsigned>(std::atoi(texts[3]));
    config.pdrf = data[104];
    config.minor_version = data[25];
    config.extra_bytes = static_cast<int>(length) - lazperf::baseCount(config.pdrf);
    lazperf::writer::named_file out(texts[2], config);
    int chunk = 3;
    int left = std::atoi(texts[chunk]);
    for (std::size_t at = number(96, std::uint32_t{}); at + length <= data.size(); at += length) {
        if (arguments > 4 && left-- == 0) {
            out.newChunk();
            left = std::atoi(texts[++chunk]) - 1;
        }
        out.writePoint(&data[at]);
    }
    out.close();
}
