#define H5_USE_110_API  // the oldest that is built with; later ones have it, too
#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <map>
#include <set>
#include <utility>

#include "analysis/modal/recording/array_file.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// An identifier of the library, released by the function that its kind has.
class Handle {
 public:
  Handle(hid_t id, herr_t (*release)(hid_t)) : id_{id}, release_{release} {}
  Handle(Handle&& other) noexcept
      : id_{std::exchange(other.id_, H5I_INVALID_HID)}, release_{other.release_} {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (is_valid()) {
      release_(id_);
    }
  }
  bool is_valid() const { return id_ >= 0; }
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  herr_t (*release_)(hid_t);
};

// Where an array is: a data set or an attribute of an object, or one member of its elements.
struct Place {
  std::string object;
  std::string attribute{};
  std::string member{};
};

// An HDF5 file's numeric data sets of one or two dimensions and its numeric scalar attributes.
class Hdf5Arrays {
 public:
  explicit Hdf5Arrays(const std::string& path)
      : path_{path}, file_{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose} {
    if (!file_.is_valid()) {
      throw core::InvalidInput{path + ": cannot be read as an HDF5 file: is it one, or cut off?"};
    }
    add_group("");
  }

  const std::vector<NamedArray>& arrays() const { return arrays_; }

  // The library stores the last dimension contiguously, so that the array's rows are that.
  std::vector<double> values_of(const NamedArray& array) const {
    const Place& place = places_.at(array.name);
    std::vector<double> values(array.size());
    const Handle object{H5Oopen(file_.get(), place.object.c_str(), H5P_DEFAULT), H5Oclose};
    const Handle type = type_in_memory(place.member);
    herr_t status = -1;
    if (place.attribute.empty()) {
      status = H5Dread(object.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    } else {
      const Handle attribute{H5Aopen(object.get(), place.attribute.c_str(), H5P_DEFAULT), H5Aclose};
      status = H5Aread(attribute.get(), type.get(), values.data());
    }
    if (status < 0) {
      throw core::InvalidInput{fmt::format(
          "{}: its data set {} cannot be read: is the file cut off, or compressed by a filter that "
          "is not installed?",
          path_, array.name)};
    }
    return values;
  }

 private:
  static Handle type_in_memory(const std::string& member) {
    if (member.empty()) {
      return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
    }
    Handle type{H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose};
    H5Tinsert(type.get(), member.c_str(), 0, H5T_NATIVE_DOUBLE);
    return type;
  }

  static std::string name_at(hid_t group, hsize_t index) {
    const auto length =
        H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, index, nullptr, 0, H5P_DEFAULT);
    std::string name(length > 0 ? static_cast<std::size_t>(length) : 0, ' ');
    H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, index, name.data(), name.size() + 1,
                       H5P_DEFAULT);
    return name;
  }

  void add_group(const std::string& name) {
    const Handle group{H5Oopen(file_.get(), name.empty() ? "/" : name.c_str(), H5P_DEFAULT),
                       H5Oclose};
    H5O_info_t object_info{};
    H5G_info_t info{};
    if (H5Oget_info(group.get(), &object_info) < 0 || H5Gget_info(group.get(), &info) < 0 ||
        !groups_.emplace(object_info.fileno, object_info.addr).second) {
      return;  // a group may hold itself
    }
    add_attributes(group.get(), name);
    for (hsize_t i = 0; i < info.nlinks; ++i) {
      add_object(group.get(), name, name_at(group.get(), i));
    }
  }

  void add_object(hid_t group, const std::string& group_name, const std::string& own) {
    const Handle object{H5Oopen(group, own.c_str(), H5P_DEFAULT), H5Oclose};
    const std::string path = group_name.empty() ? own : group_name + '/' + own;
    const H5I_type_t kind = object.is_valid() ? H5Iget_type(object.get()) : H5I_BADID;
    if (kind == H5I_GROUP) {
      add_group(path);
    } else if (kind == H5I_DATASET) {
      // Octave has a group of each variable, with its type and value
      const bool is_octave = own == "value" && H5Lexists(group, "type", H5P_DEFAULT) > 0;
      add_data_set(object.get(), path, is_octave && !group_name.empty() ? group_name : path);
    }
  }

  void add_data_set(hid_t set, const std::string& path, const std::string& name) {
    const Handle space{H5Dget_space(set), H5Sclose};
    const Handle type{H5Dget_type(set), H5Tclose};
    add_arrays(space, type, name, {.object = path});
    add_attributes(set, path);
  }

  void add_attributes(hid_t object, const std::string& path) {
    const std::string within = path.empty() ? "" : path + '/';
    const int count = H5Aget_num_attrs(object);
    for (int i = 0; i < count; ++i) {
      const Handle attribute{H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC,
                                            static_cast<hsize_t>(i), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose};
      std::array<char, 256> name{};
      const bool is_named = H5Aget_name(attribute.get(), name.size(), name.data()) > 0;
      const Handle space{H5Aget_space(attribute.get()), H5Sclose};
      const Handle type{H5Aget_type(attribute.get()), H5Tclose};
      if (is_named && H5Sget_simple_extent_npoints(space.get()) == 1 && is_number(type.get())) {
        add(within + name.data(), 1, 1,
            {.object = path.empty() ? "/" : path, .attribute = name.data()});
      }
    }
  }

  static bool is_number(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    return kind == H5T_INTEGER || kind == H5T_FLOAT;
  }

  void add_arrays(const Handle& space, const Handle& type, const std::string& name,
                  const Place& place) {
    std::array<hsize_t, 2> extent{1, 1};
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank < 0 || rank > 2 ||
        H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr) != rank) {
      return;
    }
    const auto rows = static_cast<std::size_t>(rank == 2 ? extent[1] : extent[0]);
    const auto columns = static_cast<std::size_t>(rank == 2 ? extent[0] : 1);
    if (is_number(type.get())) {
      add(name, rows, columns, place);
    } else if (H5Tget_class(type.get()) == H5T_COMPOUND) {
      for (const std::string& member : real_members(type.get())) {
        add(name + '/' + member, rows, columns, {place.object, "", member});
      }
    }
  }

  // A complex number is written as a real and an imaginary member.
  static std::vector<std::string> real_members(hid_t type) {
    std::vector<std::string> members;
    const int count = H5Tget_nmembers(type);
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<unsigned>(i);
      const Handle member{H5Tget_member_type(type, at), H5Tclose};
      if (is_number(member.get())) {
        char* const name = H5Tget_member_name(type, at);
        members.emplace_back(name);
        H5free_memory(name);
      }
    }
    const bool is_complex = count == 2 && members.size() == 2 && members[0].starts_with('r') &&
                            members[1].starts_with('i');
    return is_complex ? std::vector<std::string>{} : members;
  }

  void add(const std::string& name, std::size_t rows, std::size_t columns, const Place& place) {
    if (rows > 0 && columns > 0 && columns <= max_array_values / rows &&
        places_.emplace(name, place).second) {
      arrays_.push_back({name, rows, columns});
    }
  }

  std::string path_;
  Handle file_;
  std::vector<NamedArray> arrays_;
  std::map<std::string, Place> places_;
  std::set<std::pair<unsigned long, haddr_t>> groups_;  // that were seen
};
}  // namespace

Recording read_hdf5_file(const std::string& file, const ReadingOptions& options) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // its errors are told once, by us
  const Hdf5Arrays opened{file};
  return recording_in({file, '/', opened.arrays(),
                       "data sets of one or two dimensions are searched, complex ones are not",
                       [&](const NamedArray& array) { return opened.values_of(array); }},
                      options);
}
}  // namespace tapstudy::analysis
