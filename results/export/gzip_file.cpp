#include "results/export/gzip_file.hpp"

#include <zlib.h>

#include <utility>

#include "core/files/output_files.hpp"
namespace tapstudy::results {
namespace {
core::WritingFailed failure(const std::string& file) {
  return core::WritingFailed{file};
}
}  // namespace

GzipFile::GzipFile(const std::string& file) : file_{file}, handle_{gzopen(file.c_str(), "wxb")} {
  if (handle_ == nullptr) {
    throw core::InvalidInput{file + ": cannot be written"};
  }
}

GzipFile::~GzipFile() {
  if (handle_ != nullptr) {
    gzclose(handle_);
  }
}

void GzipFile::add(const std::string& text) {
  if (!text.empty() && gzfwrite(text.data(), 1, text.size(), handle_) != text.size()) {
    throw failure(file_);
  }
}

void GzipFile::close() {
  if (gzclose(std::exchange(handle_, nullptr)) != Z_OK) {
    throw failure(file_);
  }
}
}  // namespace tapstudy::results
