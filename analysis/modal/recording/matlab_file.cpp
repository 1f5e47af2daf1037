#include <fmt/format.h>
#include <hdf5.h>
#include <matio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>

#include "analysis/modal/recording/array_file.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
struct CloseMatlab {
  void operator()(mat_t* file) const { Mat_Close(file); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatlabFile = std::unique_ptr<mat_t, CloseMatlab>;
using MatlabVariable = std::unique_ptr<matvar_t, CloseMatlab>;

bool is_numeric(const matvar_t& variable) {
  return variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64 &&
         variable.isComplex == 0 && variable.isLogical == 0 && variable.rank == 2;
}

bool is_structure(const matvar_t& variable) {
  return variable.class_type == MAT_C_STRUCT && variable.rank == 2 && variable.dims[0] == 1 &&
         variable.dims[1] == 1;  // one, not a list of them
}

void add_arrays(matvar_t& variable, const std::string& name, std::vector<NamedArray>& arrays) {
  constexpr std::ptrdiff_t most_levels = 8;
  if (is_structure(variable) && std::ranges::count(name, '.') < most_levels) {
    char* const* const fields = Mat_VarGetStructFieldnames(&variable);
    for (unsigned i = 0; i < Mat_VarGetNumberOfFields(&variable); ++i) {
      if (matvar_t* const field = Mat_VarGetStructFieldByIndex(&variable, i, 0)) {
        add_arrays(*field, fmt::format("{}.{}", name, fields[i]), arrays);
      }
    }
    return;
  }
  const std::size_t rows = is_numeric(variable) ? variable.dims[0] : 0;
  const std::size_t columns = is_numeric(variable) ? variable.dims[1] : 0;
  if (rows > 0 && columns > 0 && columns <= max_array_values / rows) {
    arrays.push_back({name, rows, columns});
  }
}

// The real matrices of numbers in the file and in its structures.
std::vector<NamedArray> matlab_arrays(mat_t* file) {
  std::vector<NamedArray> arrays;
  for (MatlabVariable one{Mat_VarReadNextInfo(file)}; one; one.reset(Mat_VarReadNextInfo(file))) {
    if (one->name != nullptr) {
      add_arrays(*one, one->name, arrays);
    }
  }
  Mat_Rewind(file);
  return arrays;
}

template <class Number>
std::vector<double> as_doubles(const matvar_t& variable, std::size_t count) {
  const auto* const first = static_cast<const Number*>(variable.data);
  std::vector<double> values(count);
  std::transform(first, first + count, values.begin(),
                 [](Number value) { return static_cast<double>(value); });
  return values;
}

std::vector<double> doubles_of(const matvar_t& variable, std::size_t count) {
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return as_doubles<double>(variable, count);
    case MAT_C_SINGLE:
      return as_doubles<float>(variable, count);
    case MAT_C_INT8:
      return as_doubles<std::int8_t>(variable, count);
    case MAT_C_UINT8:
      return as_doubles<std::uint8_t>(variable, count);
    case MAT_C_INT16:
      return as_doubles<std::int16_t>(variable, count);
    case MAT_C_UINT16:
      return as_doubles<std::uint16_t>(variable, count);
    case MAT_C_INT32:
      return as_doubles<std::int32_t>(variable, count);
    case MAT_C_UINT32:
      return as_doubles<std::uint32_t>(variable, count);
    case MAT_C_INT64:
      return as_doubles<std::int64_t>(variable, count);
    default:
      return as_doubles<std::uint64_t>(variable, count);
  }
}

// Column after column.
std::vector<double> values_of(mat_t* file, const NamedArray& array, const std::string& path) {
  std::string name = array.name;
  std::size_t dot = name.find('.');
  const MatlabVariable outermost{Mat_VarRead(file, name.substr(0, dot).c_str())};
  matvar_t* variable = outermost.get();
  while (variable != nullptr && dot != std::string::npos) {
    name = name.substr(dot + 1);
    dot = name.find('.');
    variable = Mat_VarGetStructFieldByName(variable, name.substr(0, dot).c_str(), 0);
  }
  if (variable == nullptr || variable->data == nullptr || !is_numeric(*variable) ||
      variable->data_size <= 0 ||
      variable->nbytes / static_cast<std::size_t>(variable->data_size) < array.size()) {
    throw core::InvalidInput{
        fmt::format("{}: its variable {} cannot be read: is the file cut off?", path, array.name)};
  }
  return doubles_of(*variable, array.size());
}

[[noreturn]] void refuse_matlab(const std::string& file) {
  throw core::InvalidInput{
      file + ": cannot be read as a MATLAB file (versions 4 to 7.3): is it one, or cut off?"};
}

// One of version 7.3 is HDF5, which states where it ends; matio takes a cut one for empty.
void check_opens(const std::string& file) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (opened < 0) {
    refuse_matlab(file);
  }
  H5Fclose(opened);
}

// A file of version 5 is a header and elements one after another, each with its number of bytes:
// matio would read zeros for what is not there.
void check_is_whole(const std::string& file) {
  constexpr std::size_t header_bytes = 128;
  constexpr std::size_t tag_bytes = 8;
  std::ifstream stream{file, std::ios::binary};
  std::array<char, header_bytes> header{};
  if (!stream.read(header.data(), header.size())) {
    return;
  }
  const std::string version{header.data() + header_bytes - 4, 4};
  if (version == std::string{"\0\2IM", 4} || version == std::string{"\2\0MI", 4}) {
    return check_opens(file);
  }
  const bool is_big_endian = version == std::string{"\1\0MI", 4};
  if (!is_big_endian && version != std::string{"\0\1IM", 4}) {
    return;  // of another version
  }
  const std::uintmax_t bytes = std::filesystem::file_size(file);
  std::uintmax_t stated = header_bytes;
  std::array<char, tag_bytes> tag{};
  while (stated < bytes) {
    std::uint32_t size = 0;
    stream.seekg(static_cast<std::streamoff>(stated));
    const bool is_there = static_cast<bool>(stream.read(tag.data(), tag.size()));
    for (std::size_t i = 0; is_there && i < 4; ++i) {
      size = size << 8 | static_cast<unsigned char>(tag.at(is_big_endian ? 4 + i : 7 - i));
    }
    stated += tag_bytes + size;
  }
  if (stated != bytes) {
    throw core::InvalidInput{
        fmt::format("{}: the file is cut off: {} of {} bytes are there", file, bytes, stated)};
  }
}
}  // namespace

Recording read_matlab_file(const std::string& file, const ReadingOptions& options) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors of version 7.3's are told once, by us
  check_is_whole(file);
  const MatlabFile opened{Mat_Open(file.c_str(), MAT_ACC_RDONLY)};
  if (!opened && H5Fis_hdf5(file.c_str()) > 0) {
    return read_hdf5_file(file, options);
  }
  if (!opened) {
    refuse_matlab(file);
  }
  return recording_in(
      {file, '.', matlab_arrays(opened.get()),
       "cells and lists of structures are not searched: save their arrays as variables",
       [&](const NamedArray& array) { return values_of(opened.get(), array, file); }},
      options);
}
}  // namespace tapstudy::analysis
