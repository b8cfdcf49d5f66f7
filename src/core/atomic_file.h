// Output files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace photohull {

/// A file that is written under a temporary name in its own folder and takes its final name only
/// when it is complete and on the disk. Whatever stood under the final name stays until then.
///
///   AtomicFile file("mesh.ply");
///   file.write(bytes, size);   // or let somebody else write to file.temporary()
///   file.commit();
///
/// Not committed, the destructor removes the temporary. Every failure is an Error that names the
/// target, the system's reason and the mend.
class AtomicFile {
 public:
  /// Creates the empty temporary. Throws Error when the folder does not exist or takes no files,
  /// or when `target` exists and is not a regular file.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Appends bytes; throws Error on a full disk or any other short write.
  void write(const void* data, std::size_t size);
  /// For those who write to temporary() themselves: throws the Error for a failed write.
  /// `error_number` is the errno of the failure; 0 when it is not known.
  [[noreturn]] void fail(int error_number) const;
  /// Brings what was written to the disk; throws Error when that fails.
  void flush() const;
  /// Flushes and renames. Throws Error when either fails; the temporary is then removed by the
  /// destructor.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

/// Removes a file, on the disk too, where there is one. Throws Error when that fails.
void remove_file(const std::filesystem::path& path);

/// Contents at hand, written by an AtomicFile.
void write_atomically(const std::filesystem::path& path, std::string_view contents);

}  // namespace photohull
