#pragma once
#include <string>

struct gzFile_s;
namespace tapstudy::results {
// A new gzip file (RFC 1952), without a time: equal texts, equal bytes. Throws InvalidInput naming
// the file if it cannot be written.
class GzipFile {
 public:
  explicit GzipFile(const std::string& file);
  ~GzipFile();
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;
  GzipFile(GzipFile&&) = delete;
  GzipFile& operator=(GzipFile&&) = delete;
  void add(const std::string& text);
  // Throws if not everything was written.
  void close();

 private:
  std::string file_;
  gzFile_s* handle_;
};
}  // namespace tapstudy::results
