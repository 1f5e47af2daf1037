// Stands in for liblsl: the entry points that tapstudy calls, with the signatures of its C
// interface. What is pushed goes to the file that TAPSTUDY_LSL_LOG names, a line a sample.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {
struct Stream {
  std::string type;
  int channels;
};
std::FILE* log_file() {
  static std::FILE* const file = std::fopen(std::getenv("TAPSTUDY_LSL_LOG"), "w");
  return file;
}
const Stream& stream_of(void* outlet) {
  return *static_cast<Stream*>(outlet);
}
}  // namespace

extern "C" {
void* lsl_create_streaminfo(const char* name, const char* type, int channels, double rate_hz,
                            int format, const char* source) {
  std::fprintf(log_file(), "stream\t%s\t%s\t%d\t%g\t%d\t%s\n", name, type, channels, rate_hz,
               format, source);
  return new Stream{type, channels};
}
void lsl_destroy_streaminfo(void* info) {
  delete static_cast<Stream*>(info);
}
void* lsl_get_desc(void* info) {
  return info;
}
void* lsl_append_child(void* parent, const char* /*name*/) {
  return parent;
}
void* lsl_append_child_value(void* parent, const char* name, const char* value) {
  std::fprintf(log_file(), "%s\t%s\n", name, value);
  return parent;
}
void* lsl_create_outlet(void* info, int /*samples_in_chunk*/, int /*max_buffered*/) {
  return new Stream{stream_of(info)};
}
void lsl_destroy_outlet(void* outlet) {
  delete static_cast<Stream*>(outlet);
  std::fflush(log_file());
}
int lsl_push_sample_strtp(void* /*outlet*/, const char** values, double at_s, int /*at_once*/) {
  std::fprintf(log_file(), "marker\t%.9f\t%s\n", at_s, *values);
  return 0;
}
int lsl_push_sample_dtp(void* outlet, const double* values, double at_s, int /*at_once*/) {
  std::fprintf(log_file(), "force\t%.9f", at_s);
  for (int i = 0; i < stream_of(outlet).channels; ++i) {
    std::fprintf(log_file(), "\t%.17g", values[i]);
  }
  std::fprintf(log_file(), "\n");
  return 0;
}
double lsl_local_clock() {
  const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}
}
