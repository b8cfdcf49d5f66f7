// After PKWARE's APPNOTE.TXT 6.3 and Pixar's "Usdz File Format Specification".
#include "io/mesh/stored_zip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace photohull {
namespace {

constexpr std::uint64_t kAlignment = 64;
constexpr std::uint32_t kLocal = 0x04034b50, kCentral = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 10, kFirstDay = 0x21;  // 1 January 1980
constexpr std::uint16_t kPaddingField = 0x1986;  // of extra fields: what Pixar's own tools write

/// Little-endian numbers.
class Record {
 public:
  Record& word(std::uint64_t value) { return put(value, 2); }
  Record& dword(std::uint64_t value) { return put(value, 4); }
  Record& text(const std::string& text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  Record& zeros(std::size_t count) {
    bytes_.resize(bytes_.size() + count, 0);
    return *this;
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  Record& put(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes_.push_back(std::uint8_t(value >> (8 * i)));
    return *this;
  }
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

void StoredZip::write(const std::vector<std::uint8_t>& bytes) {
  file_.write(bytes.data(), bytes.size());
  written_ += bytes.size();
}

void StoredZip::add(const std::string& name, std::span<const std::uint8_t> bytes) {
  constexpr std::uint64_t kHeader = 30, kField = 4;
  if (written_ + bytes.size() + 4096 > std::numeric_limits<std::uint32_t>::max())
    throw Error(concat(file_.target().string(),
                       ": a USDZ file holds 4 GiB at most; export another format, or a smaller "
                       "mesh or texture"));
  uLong crc = crc32(0, nullptr, 0);
  for (std::size_t at = 0; at < bytes.size(); at += std::size_t(1) << 30)
    crc = crc32(crc, bytes.data() + at, uInt(std::min(bytes.size() - at, std::size_t(1) << 30)));
  const Entry entry{name, std::uint32_t(crc), std::uint32_t(bytes.size()), std::uint32_t(written_)};
  const std::uint64_t start = written_ + kHeader + name.size() + kField;
  const std::uint64_t padding = (kAlignment - start % kAlignment) % kAlignment;
  Record header;
  header.dword(kLocal).word(kVersion).word(0).word(0).word(0).word(kFirstDay);
  header.dword(entry.crc).dword(entry.size).dword(entry.size);
  header.word(name.size()).word(kField + padding).text(name);
  header.word(kPaddingField).word(padding).zeros(padding);
  write(header.bytes());
  file_.write(bytes.data(), bytes.size());
  written_ += bytes.size();
  entries_.push_back(entry);
}

void StoredZip::finish() {
  const std::uint64_t first = written_;
  for (const Entry& e : entries_) {
    Record record;
    record.dword(kCentral).word(kVersion).word(kVersion).word(0).word(0).word(0).word(kFirstDay);
    record.dword(e.crc).dword(e.size).dword(e.size).word(e.name.size());
    record.word(0).word(0).word(0).word(0).dword(0).dword(e.offset).text(e.name);
    write(record.bytes());
  }
  Record end;
  end.dword(kEnd).word(0).word(0).word(entries_.size()).word(entries_.size());
  end.dword(written_ - first).dword(first).word(0);
  write(end.bytes());
}

}  // namespace photohull
