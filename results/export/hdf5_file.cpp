#include "results/export/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.hpp"
namespace tapstudy::results {
namespace {
constexpr hsize_t rows_per_chunk = 4096;
constexpr unsigned deflate_level = 6;

// An object of the library, closed at the end of the scope.
class Owned {
 public:
  using Close = herr_t (*)(hid_t);
  Owned(hid_t id, Close close, const std::string& file) : id_{id}, close_{close} {
    if (id < 0) {
      throw core::InvalidInput{file + ": writing failed (is the disk full?)"};
    }
  }
  ~Owned() { close_(id_); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  Owned(Owned&&) = delete;
  Owned& operator=(Owned&&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): as the library's

 private:
  hid_t id_;
  Close close_;
};

void check(herr_t code, const std::string& file) {
  if (code < 0) {
    throw core::InvalidInput{file + ": writing failed (is the disk full?)"};
  }
}

// No longer than the data.
hsize_t chunk_of(hsize_t rows) {
  return std::min(rows, rows_per_chunk);
}

hid_t text_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

// The library's names of types are expressions.
hid_t type_of(const double* /*numbers*/) {
  return H5T_NATIVE_DOUBLE;
}
hid_t type_of(const std::int64_t* /*numbers*/) {
  return H5T_NATIVE_INT64;
}

void write_attribute(hid_t file, const std::string& name, const std::string& path,
                     const std::string& attribute, hid_t type, hid_t space, const void* value) {
  const Owned made{H5Acreate_by_name(file, path.c_str(), attribute.c_str(), type, space,
                                     H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose, name};
  check(H5Awrite(made, type, value), name);
}

std::vector<const char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  std::ranges::transform(texts, std::back_inserter(pointers), &std::string::c_str);
  return pointers;
}
}  // namespace

struct Hdf5File::Handle {
  hid_t id{H5I_INVALID_HID};
};
struct Hdf5File::Shape {
  std::vector<hsize_t> size;   // in each dimension
  std::vector<hsize_t> chunk;  // likewise
};

Hdf5File::Hdf5File(const std::string& file) : file_{file}, handle_{std::make_unique<Handle>()} {
  H5dont_atexit();  // where it would crash over a file that it could not finish
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are told once, by us
  handle_->id = H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
  if (handle_->id < 0) {
    throw core::InvalidInput{file + ": cannot be written"};
  }
}

Hdf5File::~Hdf5File() {
  if (handle_->id >= 0) {
    H5Fclose(handle_->id);
  }
}

void Hdf5File::close() {
  check(H5Fflush(handle_->id, H5F_SCOPE_GLOBAL), file_);
  check(H5Fclose(std::exchange(handle_->id, H5I_INVALID_HID)), file_);
}

void Hdf5File::add_group(const std::string& path) {
  const Owned group{H5Gcreate2(handle_->id, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                    H5Gclose, file_};
}

void Hdf5File::describe(const std::string& path, const std::string& attribute,
                        const std::string& text) {
  const Owned type{text_type(), H5Tclose, file_};
  const Owned space{H5Screate(H5S_SCALAR), H5Sclose, file_};
  const char* const value = text.c_str();
  write_attribute(handle_->id, file_, path, attribute, type, space, &value);
}

void Hdf5File::describe(const std::string& path, const std::string& attribute,
                        const std::vector<std::string>& texts) {
  const Owned type{text_type(), H5Tclose, file_};
  const hsize_t count = texts.size();
  const Owned space{H5Screate_simple(1, &count, nullptr), H5Sclose, file_};
  const std::vector<const char*> pointers = pointers_to(texts);
  write_attribute(handle_->id, file_, path, attribute, type, space, pointers.data());
}

void Hdf5File::describe(const std::string& path, const std::string& attribute,
                        std::int64_t number) {
  const Owned space{H5Screate(H5S_SCALAR), H5Sclose, file_};
  write_attribute(handle_->id, file_, path, attribute, H5T_NATIVE_INT64, space, &number);
}

void Hdf5File::add_texts(const std::string& path, const std::vector<const char*>& texts) {
  const Owned type{text_type(), H5Tclose, file_};
  const hsize_t count = texts.size();
  const Owned space{H5Screate_simple(1, &count, nullptr), H5Sclose, file_};
  const Owned settings{H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file_};
  H5Pset_obj_track_times(settings, false);
  const Owned set{
      H5Dcreate2(handle_->id, path.c_str(), type, space, H5P_DEFAULT, settings, H5P_DEFAULT),
      H5Dclose, file_};
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), file_);
}

template <class Number>
void Hdf5File::add_numbers(const std::string& path, const Shape& shape, const Number* numbers) {
  const auto dimensions = static_cast<int>(shape.size.size());
  const Owned space{H5Screate_simple(dimensions, shape.size.data(), nullptr), H5Sclose, file_};
  const Owned settings{H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file_};
  H5Pset_obj_track_times(settings, false);
  if (shape.size.front() > 0) {  // what is empty has no chunks
    H5Pset_chunk(settings, dimensions, shape.chunk.data());
    H5Pset_shuffle(settings);
    H5Pset_deflate(settings, deflate_level);
  }
  const Owned set{H5Dcreate2(handle_->id, path.c_str(), type_of(numbers), space, H5P_DEFAULT,
                             settings, H5P_DEFAULT),
                  H5Dclose, file_};
  check(H5Dwrite(set, type_of(numbers), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers), file_);
}

void Hdf5File::add_integers(const std::string& path, const std::vector<std::int64_t>& numbers) {
  add_numbers(path, {{numbers.size()}, {chunk_of(numbers.size())}}, numbers.data());
}

void Hdf5File::add_reals(const std::string& path, const std::vector<double>& numbers) {
  add_numbers(path, {{numbers.size()}, {chunk_of(numbers.size())}}, numbers.data());
}

void Hdf5File::add_matrix(const std::string& path, std::span<const double> numbers,
                          std::size_t columns) {
  const hsize_t rows = numbers.size() / columns;
  add_numbers(path, {{rows, columns}, {chunk_of(rows), 1}}, numbers.data());
}
}  // namespace tapstudy::results
