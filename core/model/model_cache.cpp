#include "core/model/model_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/files/sha256.hpp"
namespace tapstudy::core {
namespace {
namespace fs = std::filesystem;
constexpr std::size_t hash_length = 64;
constexpr std::int64_t max_entries = 1LL << 32;

const char* as_bytes(const void* data) {
  return static_cast<const char*>(data);
}

class Writer {
 public:
  template <class Value>
  void put(const Value& value) {
    static_assert(std::is_arithmetic_v<Value>);
    bytes_.append(as_bytes(&value), sizeof value);
  }
  template <class Matrix>
  void put_all(const Matrix& matrix) {
    put(static_cast<std::int64_t>(matrix.rows()));
    put(static_cast<std::int64_t>(matrix.cols()));
    bytes_.append(as_bytes(matrix.data()),
                  sizeof(*matrix.data()) * static_cast<std::size_t>(matrix.size()));
  }
  void put_text(const std::string& text) {
    put_all(Eigen::Map<const Eigen::Matrix<char, Eigen::Dynamic, 1>>{
        text.data(), static_cast<Eigen::Index>(text.size())});
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Reads what Writer wrote; never reads past the end.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_{bytes} {}
  template <class Value>
  void get(Value& value) {
    static_assert(std::is_arithmetic_v<Value>);
    copy(&value, sizeof value);
  }
  template <class Matrix>
  void get_all(Matrix& matrix) {
    std::int64_t rows = 0;
    std::int64_t columns = 0;
    get(rows);
    get(columns);
    const bool fits =
        rows >= 0 && columns >= 0 && rows < max_entries && columns < max_entries &&
        (columns == 0 || rows <= max_entries / columns) &&
        sizeof(*matrix.data()) * static_cast<std::size_t>(rows * columns) <= bytes_.size() &&
        (Matrix::ColsAtCompileTime == Eigen::Dynamic || columns == Matrix::ColsAtCompileTime);
    if (!fits) {
      is_good_ = false;
      return;
    }
    matrix.resize(rows, columns);
    copy(matrix.data(), sizeof(*matrix.data()) * static_cast<std::size_t>(matrix.size()));
  }
  void get_text(std::string& text) {
    Eigen::Matrix<char, Eigen::Dynamic, 1> characters;
    get_all(characters);
    text.assign(characters.begin(), characters.end());
  }
  bool is_good_and_done() const { return is_good_ && bytes_.empty(); }
  bool is_good() const { return is_good_; }

 private:
  void copy(void* to, std::size_t size) {
    if (!is_good_ || size > bytes_.size()) {
      is_good_ = false;
      return;
    }
    bytes_.copy(static_cast<char*>(to), size);  // of nothing, where a matrix is empty
    bytes_.remove_prefix(size);
  }
  std::string_view bytes_;
  bool is_good_{true};
};

// Visits the fields of a report, for both reading and writing.
template <class Report, class Visit>
void each_number(Report& report, const Visit& visit) {
  visit(report.nodes);
  visit(report.tets);
  visit(report.dofs);
  visit(report.rigid_body_modes);
  visit(report.counted_in_band);
  visit(report.worst_residual);
  visit(report.cost.mesh_s);
  visit(report.cost.assemble_s);
  visit(report.cost.factor_s);
  visit(report.cost.iterate_s);
}
}  // namespace

std::string encoded(const BodyModes& modes) {
  Writer writer;
  writer.put_all(Eigen::VectorXd{modes.kappa_rad_per_m.matrix()});
  writer.put(modes.band_limit_rad_per_m);
  writer.put_all(modes.touch_nodes_m);
  writer.put_all(modes.touch_surface);
  writer.put_all(modes.shape);
  writer.put_all(modes.kinetic_share);
  writer.put_all(modes.strain_share);
  each_number(modes.report, [&](const auto& number) { writer.put(number); });
  writer.put(static_cast<std::int64_t>(modes.report.bodies.size()));
  for (const MeshedBody& body : modes.report.bodies) {
    writer.put(body.order);
    writer.put(body.radius_edge_ratio.asked);
    writer.put(body.radius_edge_ratio.used);
  }
  writer.put(static_cast<std::int64_t>(modes.report.refinement.size()));
  for (const RefinementRound& round : modes.report.refinement) {
    writer.put(round.tets);
    writer.put(round.modes);
    writer.put(round.moved);
  }
  writer.put_all(Eigen::VectorXd{modes.estimate.kappa_rad_per_m.matrix()});
  writer.put_text(modes.estimate.not_estimated);
  writer.put_text(modes.estimate.held_in_part);
  writer.put(modes.estimate.seconds);
  return writer.take();
}

std::optional<BodyModes> decoded(const std::string& bytes) {
  Reader reader{bytes};
  BodyModes modes;
  Eigen::VectorXd kappa;
  reader.get_all(kappa);
  reader.get(modes.band_limit_rad_per_m);
  reader.get_all(modes.touch_nodes_m);
  reader.get_all(modes.touch_surface);
  reader.get_all(modes.shape);
  reader.get_all(modes.kinetic_share);
  reader.get_all(modes.strain_share);
  modes.kappa_rad_per_m = kappa;
  each_number(modes.report, [&](auto& number) { reader.get(number); });
  std::int64_t bodies = 0;
  reader.get(bodies);
  while (reader.is_good() && bodies-- > 0) {
    MeshedBody& body = modes.report.bodies.emplace_back();
    reader.get(body.order);
    reader.get(body.radius_edge_ratio.asked);
    reader.get(body.radius_edge_ratio.used);
  }
  std::int64_t rounds = 0;
  reader.get(rounds);
  while (reader.is_good() && rounds-- > 0) {
    RefinementRound round;
    reader.get(round.tets);
    reader.get(round.modes);
    reader.get(round.moved);
    modes.report.refinement.push_back(round);
  }
  Eigen::VectorXd larger;
  reader.get_all(larger);
  modes.estimate.kappa_rad_per_m = larger;
  reader.get_text(modes.estimate.not_estimated);
  reader.get_text(modes.estimate.held_in_part);
  reader.get(modes.estimate.seconds);
  return reader.is_good_and_done() ? std::optional{modes} : std::nullopt;
}

std::string ModelCache::full_key(const std::string& key) const {
  return fmt::format("tapstudy {}\n{}\n", version_, key);
}

std::string ModelCache::file_of(const std::string& key) const {
  return (fs::path{directory_} / (sha256(full_key(key)) + ".modes")).string();
}

std::optional<BodyModes> ModelCache::find(const std::string& key) const {
  std::error_code error;
  if (directory_.empty() || !fs::is_regular_file(file_of(key), error)) {
    return std::nullopt;
  }
  std::ifstream file{file_of(key), std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  const std::string head = full_key(key);
  if (text.size() < head.size() + hash_length || !text.starts_with(head)) {
    return std::nullopt;
  }
  const std::string body = text.substr(head.size(), text.size() - head.size() - hash_length);
  if (sha256(body) != text.substr(text.size() - hash_length)) {
    return std::nullopt;
  }
  return decoded(body);
}

bool ModelCache::store(const std::string& key, const BodyModes& modes) const {
  if (directory_.empty()) {
    return true;
  }
  std::error_code error;
  fs::create_directories(directory_, error);
  const std::string body = encoded(modes);
  const std::string place = file_of(key);
  const std::string beside = fmt::format("{}.{}", place, getpid());
  {
    std::ofstream file{beside, std::ios::binary};
    file << full_key(key) << body << sha256(body);
    file.close();
    if (!file) {
      fs::remove(beside, error);
      return false;
    }
  }
  fs::rename(beside, place, error);
  if (!error) {
    return true;
  }
  fs::remove(beside, error);
  return false;
}
}  // namespace tapstudy::core
