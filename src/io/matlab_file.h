// MATLAB's Level 5 MAT-files, as far as lists of matrices and names need them: real arrays, text
// and cells, compressed or not. Internal to io.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace photohull::io {

/// One variable or cell. Of numbers `values` by columns, of text `text`, of a cell array `cells`.
struct MatArray {
  std::string name;
  std::vector<std::size_t> dimensions;
  std::vector<double> values;
  std::string text;
  std::vector<MatArray> cells;
};

/// The variables of a file; those of other kinds (structures, objects, sparse, complex) are left
/// out. Throws Error naming file and offset for what is no MAT-file, is truncated or claims more
/// than it holds; memory stays within a small multiple of the file's size or of 256 MiB.
std::vector<MatArray> read_mat_file(const std::filesystem::path& file);

/// The bytes of an uncompressed file. The product of `dimensions` must match the values.
std::string mat_file_bytes(std::span<const MatArray> variables);

}  // namespace photohull::io
