#include <dlfcn.h>
#include <fmt/format.h>

#include <bit>
#include <chrono>
#include <string>
#include <utility>

#include "device/device.hpp"
#include "runner/session/markers/marker_output.hpp"
namespace tapstudy::runner {
namespace {
constexpr const char* library_name = "liblsl.so.2";
constexpr const char* earlier_library_name = "liblsl.so";  // up to 1.13, and the development link

// The functions of liblsl's C interface that are called. What it hands out is opaque.
class Lsl {
 public:
  enum Format : int { float64 = 2, strings = 3 };
  using Info = void*;
  using Outlet = void*;
  using Element = void*;

  Lsl() : library_{loaded()} {
    find(create_info, "lsl_create_streaminfo");
    find(destroy_info, "lsl_destroy_streaminfo");
    find(description_of, "lsl_get_desc");
    find(append_child, "lsl_append_child");
    find(append_value, "lsl_append_child_value");
    find(create_outlet, "lsl_create_outlet");
    find(destroy_outlet, "lsl_destroy_outlet");
    find(push_strings, "lsl_push_sample_strtp");
    find(push_numbers, "lsl_push_sample_dtp");
    find(local_clock, "lsl_local_clock");
  }

  Info (*create_info)(const char* name, const char* type, int channels, double rate_hz, int format,
                      const char* source_id){};
  void (*destroy_info)(Info info){};
  Element (*description_of)(Info info){};
  Element (*append_child)(Element parent, const char* name){};
  Element (*append_value)(Element parent, const char* name, const char* value){};
  Outlet (*create_outlet)(Info info, int samples_in_chunk, int max_buffered){};
  void (*destroy_outlet)(Outlet outlet){};
  int (*push_strings)(Outlet outlet, const char** values, double at_s, int at_once){};
  int (*push_numbers)(Outlet outlet, const double* values, double at_s, int at_once){};
  double (*local_clock)(){};

 private:
  // Never unloaded: its threads may outlive an outlet.
  static void* loaded() {
    for (const char* name : {library_name, earlier_library_name}) {
      if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL); library != nullptr) {
        return library;
      }
    }
    throw device::DeviceError{fmt::format(
        "markers.lsl: {} is not installed (github.com/sccn/liblsl/releases, or conda-forge's "
        "liblsl; LD_LIBRARY_PATH names its folder)",
        library_name)};
  }
  template <class Function>
  void find(Function*& function, const char* name) {
    function = std::bit_cast<Function*>(dlsym(library_, name));
    if (function == nullptr) {
      throw device::DeviceError{
          fmt::format("markers.lsl: {} has no function {}", library_name, name)};
    }
  }

  void* library_;
};

struct Channel {
  const char* label;
  const char* unit;
};

class LslOutlet {
 public:
  LslOutlet(const Lsl& lsl, const std::string& name, const char* type, Lsl::Format format,
            std::initializer_list<Channel> channels)
      : lsl_{lsl} {
    constexpr double irregular = 0.0;
    constexpr int each_at_once = 0;
    constexpr int max_buffered = 360;  // of a hundred samples each, the library's own default
    const Lsl::Info info = lsl_.create_info(name.c_str(), type, static_cast<int>(channels.size()),
                                            irregular, format, ("tapstudy " + name).c_str());
    if (info != nullptr) {
      const Lsl::Element list = lsl_.append_child(lsl_.description_of(info), "channels");
      for (const Channel& channel : channels) {
        const Lsl::Element element = lsl_.append_child(list, "channel");
        lsl_.append_value(element, "label", channel.label);
        lsl_.append_value(element, "unit", channel.unit);
      }
      outlet_ = lsl_.create_outlet(info, each_at_once, max_buffered);
      lsl_.destroy_info(info);
    }
    if (outlet_ == nullptr) {
      throw device::DeviceError{
          fmt::format("markers.lsl: liblsl makes no stream of the name '{}'", name)};
    }
  }
  ~LslOutlet() { lsl_.destroy_outlet(outlet_); }
  LslOutlet(const LslOutlet&) = delete;
  LslOutlet& operator=(const LslOutlet&) = delete;
  LslOutlet(LslOutlet&&) = delete;
  LslOutlet& operator=(LslOutlet&&) = delete;
  Lsl::Outlet get() const { return outlet_; }

 private:
  const Lsl& lsl_;
  Lsl::Outlet outlet_{};
};

class LslMarkers final : public MarkerOutput {
 public:
  explicit LslMarkers(const protocols::LslStreams& streams)
      : name_{streams.name},
        markers_{lsl_, streams.name, "Markers", Lsl::strings, {{"marker", ""}}} {
    if (streams.has_forces) {
      forces_.emplace(lsl_, streams.name + "_force", "Force", Lsl::float64,
                      std::initializer_list<Channel>{
                          {"force_x_n", "N"}, {"force_y_n", "N"}, {"force_z_n", "N"}});
    }
  }
  std::string name() const override { return "LSL stream " + name_; }

  Sent send(const Marker& marker) override {
    const results::SessionEventRow& change = marker.change;
    const std::string text = fmt::format("{} {}{}{}", change.state, change.number.value_or(-1),
                                         change.detail.empty() ? "" : " ", change.detail);
    const char* value = text.c_str();
    return lsl_.push_strings(markers_.get(), &value, at_s(marker.monotonic_ns), 1) == 0 ? Sent::yes
                                                                                        : Sent::no;
  }
  void send_force(const ForceSample& sample) override {
    if (forces_) {
      lsl_.push_numbers(forces_->get(), sample.force_n.data(), at_s(sample.monotonic_ns), 1);
    }
  }

 private:
  // By the library's own clock, whichever it is.
  double at_s(std::int64_t monotonic_ns) const {
    const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
    return lsl_.local_clock() - 1e-9 * static_cast<double>(now.count() - monotonic_ns);
  }

  Lsl lsl_;
  std::string name_;
  LslOutlet markers_;
  std::optional<LslOutlet> forces_;
};
}  // namespace

std::unique_ptr<MarkerOutput> open_lsl_markers(const protocols::LslStreams& streams) {
  return std::make_unique<LslMarkers>(streams);
}
}  // namespace tapstudy::runner
