// PostgreSQL's binary COPY format, as far as bigint and float8 go: a signature
// and 8 bytes of flags; rows of a field count (16 bits) and, per field, its
// length (32 bits, -1 = NULL) and bytes; a row of count -1. All big-endian.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace abacus::oracle {

/// A file, read or written through a large buffer; "-" is standard input or output.
class File {
public:
    File(const std::string &path, const char *mode)
        : file_(path == "-" ? (*mode == 'r' ? stdin : stdout) : std::fopen(path.c_str(), mode)),
          buffer_(1 << 20), path_(path) {
        if (file_ == nullptr) throw std::runtime_error("cannot open " + path);
        std::setvbuf(file_, buffer_.data(), _IOFBF, buffer_.size());
    }
    File(const File &) = delete;
    File &operator=(const File &) = delete;
    ~File() {
        std::fflush(file_);
        if (file_ != stdin && file_ != stdout) std::fclose(file_);
    }

    void read(void *bytes, std::size_t size) {
        if (!try_read(bytes, size)) throw std::runtime_error(path_ + " ends too early");
    }
    bool try_read(void *bytes, std::size_t size) {
        return std::fread(bytes, 1, size, file_) == size;
    }
    void write(const void *bytes, std::size_t size) {
        if (std::fwrite(bytes, 1, size, file_) != size)
            throw std::runtime_error("cannot write " + path_);
    }
    const std::string &path() const { return path_; }

private:
    std::FILE *file_;
    std::vector<char> buffer_;
    std::string path_;
};

inline std::uint16_t big_endian(std::uint16_t word) { return __builtin_bswap16(word); }
inline std::uint32_t big_endian(std::uint32_t word) { return __builtin_bswap32(word); }
inline std::uint64_t big_endian(std::uint64_t word) { return __builtin_bswap64(word); }

inline constexpr unsigned char copy_header[19] = {'P',  'G',  'C',  'O',  'P', 'Y',
                                                  '\n', 0xff, '\r', '\n', 0};

/// Rows of `Fields` 8-byte fields (bigint or float8, none NULL).
template <std::size_t Fields> class CopyReader {
public:
    explicit CopyReader(File &file) : file_(file) {
        unsigned char header[sizeof copy_header];
        file_.read(header, sizeof header);
        if (std::memcmp(header, copy_header, sizeof header) != 0)
            throw std::runtime_error(file_.path() + " is not in binary COPY format");
    }
    /// False at the end.
    bool next(std::array<std::uint64_t, Fields> &row) {
        std::uint16_t count;
        file_.read(&count, sizeof count);
        if (count == 0xffff) return false;
        if (big_endian(count) != Fields)
            throw std::runtime_error(file_.path() + ": wrong number of columns");
        Field fields[Fields];
        file_.read(fields, sizeof fields);
        for (std::size_t i = 0; i < Fields; ++i) {
            if (big_endian(fields[i].size) != 8)
                throw std::runtime_error(file_.path() + ": a column is not 8 bytes long");
            row[i] = big_endian(fields[i].word);
        }
        return true;
    }

private:
    struct __attribute__((packed)) Field {
        std::uint32_t size;
        std::uint64_t word;
    };
    File &file_;
};

template <std::size_t Fields> class CopyWriter {
public:
    explicit CopyWriter(File &file) : file_(file) { file_.write(copy_header, sizeof copy_header); }
    void put(const std::array<std::uint64_t, Fields> &row) {
        unsigned char bytes[2 + 12 * Fields];
        const std::uint16_t count = big_endian(std::uint16_t(Fields));
        std::memcpy(bytes, &count, 2);
        for (std::size_t i = 0; i < Fields; ++i) {
            const std::uint32_t size = big_endian(std::uint32_t(8));
            const std::uint64_t word = big_endian(row[i]);
            std::memcpy(bytes + 2 + 12 * i, &size, 4);
            std::memcpy(bytes + 6 + 12 * i, &word, 8);
        }
        file_.write(bytes, sizeof bytes);
    }
    void finish() { file_.write("\xff\xff", 2); }

private:
    File &file_;
};

} // namespace abacus::oracle
