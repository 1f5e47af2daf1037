#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "results/export/table.hpp"
namespace tapstudy::results {
// A new HDF5 file. Strings are UTF-8 of variable length. Every function throws InvalidInput naming
// the file if it cannot be written. Times of writing are not stored: equal data, equal bytes.
class Hdf5File {
 public:
  explicit Hdf5File(const std::string& file);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  Hdf5File(Hdf5File&&) = delete;
  Hdf5File& operator=(Hdf5File&&) = delete;

  // Paths begin with a slash; the group around an object must be there.
  void add_group(const std::string& path);
  // Of any group or dataset.
  void describe(const std::string& path, const std::string& attribute, const std::string& text);
  void describe(const std::string& path, const std::string& attribute,
                const std::vector<std::string>& texts);
  void describe(const std::string& path, const std::string& attribute, std::int64_t number);
  // One-dimensional.
  void add_texts(const std::string& path, const std::vector<const char*>& texts);
  void add_integers(const std::string& path, const std::vector<std::int64_t>& numbers);
  void add_reals(const std::string& path, const std::vector<double>& numbers);
  // rows x columns, row by row, in chunks of one column, shuffled and deflated.
  void add_matrix(const std::string& path, std::span<const double> numbers, std::size_t columns);
  // Throws if what was written is not completely on its way to the disk.
  void close();

 private:
  struct Handle;
  struct Shape;
  template <class Number>
  void add_numbers(const std::string& path, const Shape& shape, const Number* numbers);
  std::string file_;
  std::unique_ptr<Handle> handle_;
};
}  // namespace tapstudy::results
