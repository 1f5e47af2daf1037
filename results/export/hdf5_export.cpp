#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "results/export/csv_file.hpp"
#include "results/export/study_export.hpp"
#include "results/export/table.hpp"
namespace tapstudy::results {
// A new HDF5 file. Texts of attributes are UTF-8 of variable length. Every function throws
// InvalidInput naming the file if it cannot be written. Times of writing are not stored: equal
// data, equal bytes.
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
  // Row by row: as many numbers in each.
  void add_matrix(const std::string& path, std::span<const double> numbers, std::size_t rows);
  // Throws if what was written is not completely on its way to the disk.
  void close();

 private:
  struct Handle;
  struct Shape;
  // Shuffled and deflated, but for what is small.
  void add_data(const std::string& path, const Shape& shape, hid_t type, const void* data);
  std::string file_;
  std::unique_ptr<Handle> handle_;
};

namespace {
constexpr hsize_t rows_per_chunk = 4096;
constexpr hsize_t bytes_per_chunk = 1'000'000;  // of texts, at most
constexpr hsize_t most_compact_bytes = 512;     // stored beside the dataset's description
constexpr unsigned most_listed = 64;            // of a group: more are found by an index
constexpr unsigned deflate_level = 9;

// An object of the library, closed at the end of the scope.
class Owned {
 public:
  using Close = herr_t (*)(hid_t);
  Owned(hid_t id, Close close, const std::string& file) : id_{id}, close_{close} {
    if (id < 0) {
      throw core::WritingFailed{file};
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
    throw core::WritingFailed{file};
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
  // The format of 2016 has shorter descriptions. Not of the root, which would have times in it.
  H5Fset_libver_bounds(handle_->id, H5F_LIBVER_V110, H5F_LIBVER_V110);
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
  const Owned settings{H5Pcreate(H5P_GROUP_CREATE), H5Pclose, file_};
  H5Pset_obj_track_times(settings, false);
  H5Pset_link_phase_change(settings, most_listed, most_listed / 2);
  const Owned group{H5Gcreate2(handle_->id, path.c_str(), H5P_DEFAULT, settings, H5P_DEFAULT),
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

// Bytes of UTF-8 of one length, the longest, under the name of ASCII: Octave gives up the whole
// file at the first text that has its own length, or is called UTF-8. It shows these as they are,
// as R does.
void Hdf5File::add_texts(const std::string& path, const std::vector<const char*>& texts) {
  std::size_t longest = 1;
  for (const std::string_view text : texts) {
    longest = std::max(longest, text.size());
  }
  std::vector<char> packed(texts.size() * longest);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string_view text{texts[i]};
    std::ranges::copy(text, packed.begin() + static_cast<std::ptrdiff_t>(i * longest));
  }
  const Owned type{H5Tcopy(H5T_C_S1), H5Tclose, file_};
  H5Tset_size(type, longest);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const hsize_t rows = std::max<hsize_t>(1, bytes_per_chunk / longest);
  add_data(path, {{texts.size()}, {std::min(chunk_of(texts.size()), rows)}}, type, packed.data());
}

void Hdf5File::add_data(const std::string& path, const Shape& shape, hid_t type, const void* data) {
  const auto dimensions = static_cast<int>(shape.size.size());
  const Owned space{H5Screate_simple(dimensions, shape.size.data(), nullptr), H5Sclose, file_};
  const Owned settings{H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file_};
  H5Pset_obj_track_times(settings, false);
  hsize_t bytes = H5Tget_size(type);
  for (const hsize_t size : shape.size) {
    bytes *= size;
  }
  if (bytes > 0 && bytes <= most_compact_bytes) {  // what is empty has no layout of its own
    H5Pset_layout(settings, H5D_COMPACT);
  } else if (bytes > 0) {
    H5Pset_chunk(settings, dimensions, shape.chunk.data());
    H5Pset_shuffle(settings);
    H5Pset_deflate(settings, deflate_level);
  }
  const Owned set{
      H5Dcreate2(handle_->id, path.c_str(), type, space, H5P_DEFAULT, settings, H5P_DEFAULT),
      H5Dclose, file_};
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), file_);
}

void Hdf5File::add_integers(const std::string& path, const std::vector<std::int64_t>& numbers) {
  add_data(path, {{numbers.size()}, {chunk_of(numbers.size())}}, H5T_NATIVE_INT64, numbers.data());
}

void Hdf5File::add_reals(const std::string& path, const std::vector<double>& numbers) {
  add_data(path, {{numbers.size()}, {chunk_of(numbers.size())}}, H5T_NATIVE_DOUBLE, numbers.data());
}

// A chunk has a part of every row. Deflate then finds, within its 32 KiB, that alike bytes of one
// row are those of another: forces as commanded and as achieved are mostly the same.
void Hdf5File::add_matrix(const std::string& path, std::span<const double> numbers,
                          std::size_t rows) {
  const hsize_t columns = numbers.size() / rows;
  add_data(path, {{rows, columns}, {rows, chunk_of(columns)}}, H5T_NATIVE_DOUBLE, numbers.data());
}

namespace {
// One column of a table, as it is collected row by row. Equal texts are kept once.
class Values {
 public:
  void add(const Cell& cell) { std::visit(*this, cell); }
  void write(Hdf5File& file, const std::string& path, CellType type) const {
    if (type == CellType::text) {
      file.add_texts(path, texts_);
    } else if (type == CellType::real || has_missing_) {
      file.add_reals(path, reals_);
    } else {
      file.add_integers(path, integers_);
    }
  }
  void operator()(std::monostate /*missing*/) {
    has_missing_ = true;
    reals_.push_back(std::numeric_limits<double>::quiet_NaN());
    integers_.push_back(0);
    add_text(missing_in_csv);
  }
  void operator()(std::int64_t number) {
    reals_.push_back(static_cast<double>(number));
    integers_.push_back(number);
  }
  void operator()(double number) { reals_.push_back(number); }
  void operator()(const std::string& text) { add_text(text); }

 private:
  void add_text(const std::string& text) { texts_.push_back(pool_.insert(text).first->c_str()); }
  bool has_missing_{false};
  std::vector<double> reals_;
  std::vector<std::int64_t> integers_;
  std::unordered_set<std::string> pool_;
  std::vector<const char*> texts_;
};

void add_table(Hdf5File& file, const Table& table) {
  const std::string group = "/tables/" + table.name;
  file.add_group(group);
  file.describe(group, "description", table.description);
  std::vector<Values> values(table.columns.size());
  table.each_row([&](const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      values[i].add(row[i]);
    }
  });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Column& column = table.columns[i];
    const std::string path = group + "/" + column.name;
    values[i].write(file, path, column.type);
    file.describe(path, "unit", column.unit);
    file.describe(path, "description", column.description);
    names.push_back(column.name);
  }
  file.describe(group, "columns", names);
}

double number_in(const Cell& cell) {
  const auto* const integer = std::get_if<std::int64_t>(&cell);
  return integer != nullptr ? static_cast<double>(*integer) : std::get<double>(cell);
}

void add_recording(Hdf5File& file, const Recording& recording) {
  std::vector<std::string> names;
  std::vector<std::string> units;
  std::vector<std::string> descriptions;
  for (const Column& column : recording.columns) {
    names.push_back(column.name);
    units.push_back(column.unit);
    descriptions.push_back(column.description);
  }
  const std::string group = "/" + recording.name;
  file.add_group(group);
  file.describe(group, "columns", names);
  file.describe(group, "units", units);
  file.describe(group, "descriptions", descriptions);
}

void add_samples(Hdf5File& file, const std::string& recording, const Table& trace,
                 std::int64_t trial_id) {
  std::vector<std::vector<double>> columns(trace.columns.size());
  trace.each_row([&](const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      columns[i].push_back(number_in(row[i]));
    }
  });
  std::vector<double> numbers;
  for (const std::vector<double>& column : columns) {
    numbers.insert(numbers.end(), column.begin(), column.end());
  }
  const std::string path = "/" + recording + "/" + trace.name;
  file.add_matrix(path, numbers, columns.size());
  file.describe(path, "description", trace.description);
  file.describe(path, "trial_id", trial_id);
}
}  // namespace

void write_hdf5_file(const std::string& name, Store& store, const StudyExport& study) {
  Hdf5File file{name};
  file.describe("/", "title", study.provenance.title);
  file.describe("/", "protocol_sha256", study.provenance.protocol_sha256);
  file.describe("/", "program", study.provenance.program);
  file.describe("/", "missing_text", missing_in_csv);
  file.add_texts("/protocol", {study.protocol_text.c_str()});
  file.add_group("/tables");
  for (const Table& table : study.tables) {
    add_table(file, table);
  }
  const std::vector<Recording> all = recordings(store);
  for (const Recording& recording : all) {
    add_recording(file, recording);
  }
  each_traced_trial(study, [&](std::int64_t trial) {
    for (const Recording& recording : all) {
      if (const std::optional<Table> table = recording.of_trial(trial)) {
        add_samples(file, recording.name, *table, trial);
      }
    }
  });
  file.close();
}
}  // namespace tapstudy::results
