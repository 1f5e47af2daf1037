// Frequency responses in universal files and tables.
#include "analysis/modal/response/response_files.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "analysis/modal/response/response_modes.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/synthetic_responses.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
const testing::PlantedStructure two_places{{{40.0, 0.02}, {85.0, 0.01}}, 2};

FrequencyResponses few_lines() {
  return testing::planted_responses(two_places, ResponseKind::mobility, {10.0, 40.0}, 31);
}

std::string complex_bytes(const Eigen::VectorXcd& values, bool is_big_endian) {
  std::string bytes;
  for (const std::complex<double>& value : values) {
    for (const double part : {value.real(), value.imag()}) {
      std::array<char, sizeof(double)> of_part{};
      std::memcpy(of_part.data(), &part, sizeof(double));
      if (is_big_endian != (std::endian::native == std::endian::big)) {
        std::ranges::reverse(of_part);
      }
      bytes.append(of_part.data(), of_part.size());
    }
  }
  return bytes;
}

// The same function in bytes of double precision.
std::string binary_function(const FrequencyResponses& responses, Eigen::Index column,
                            bool is_big_endian) {
  const std::string text = testing::universal_function(responses, column);
  std::size_t header_end = 0;
  for (int line = 0; line < 13; ++line) {
    header_end = text.find('\n', header_end) + 1;
  }
  const std::string bytes = complex_bytes(responses.values.col(column), is_big_endian);
  std::string header =
      testing::replaced(text.substr(0, header_end), "    58\n",
                        fmt::format("    58b{:>6}{:>6}{:>12}{:>12}{:>6}{:>6}{:>12}{:>12}\n",
                                    is_big_endian ? 2 : 1, 2, 11, bytes.size(), 0, 0, 0, 0));
  header = testing::replaced(header, "         5        31", "         6        31");
  return header + bytes + "\n    -1\n";
}

// "real" and "imag", or "magnitude" and "phase_deg".
constexpr double degrees = 180.0 / std::numbers::pi;
std::string table_of(const FrequencyResponses& responses, bool is_polar,
                     double phase_unit = degrees, double sign = 1.0) {
  std::string text = "frequency_hz";
  for (const ResponsePair& pair : responses.pairs) {
    text += is_polar ? fmt::format(",{0}_magnitude,{0}_phase_deg", name(pair))
                     : fmt::format(",{0} real,{0} imag", name(pair));
  }
  text += "\n";
  for (Eigen::Index line = 0; line < responses.frequency_hz.size(); ++line) {
    text += fmt::format("{:.6g}", responses.frequency_hz[line]);
    for (const std::complex<double>& value : responses.values.row(line)) {
      text += is_polar ? fmt::format(",{:.9g},{:.9g}", sign * std::abs(value),
                                     std::arg(value) * phase_unit)
                       : fmt::format(",{:.9g},{:.9g}", value.real(), value.imag());
    }
    text += "\n";
  }
  return text;
}

struct NamedText {
  std::string name;
  std::string text;
};

FrequencyResponses read_text(const NamedText& file, std::optional<ResponseKind> kind) {
  const testing::TempDirectory directory;
  testing::write(directory / file.name, file.text);
  return read_responses({directory / file.name}, kind);
}
}  // namespace

TEST_CASE("responses are the same from universal files in text and bytes and from tables",
          "[analysis][responses][formats]") {
  const FrequencyResponses planted = few_lines();
  const bool is_big_endian = GENERATE(false, true);
  const std::vector<NamedText> files{{"text.uff", testing::universal_file(planted)},
                                     {"bytes.unv", binary_function(planted, 0, is_big_endian) +
                                                       binary_function(planted, 1, !is_big_endian)},
                                     {"parts.csv", table_of(planted, false)},
                                     {"polar.csv", table_of(planted, true)}};
  for (const NamedText& file : files) {
    CAPTURE(file.name);
    const bool is_table = file.name.ends_with(".csv");
    const FrequencyResponses read =
        read_text(file, is_table ? std::optional{planted.kind} : std::nullopt);
    CHECK(read.kind == planted.kind);
    CHECK(read.pairs == planted.pairs);
    CHECK(read.remarks.empty());
    REQUIRE(read.values.rows() == planted.values.rows());
    CHECK((read.frequency_hz - planted.frequency_hz).abs().maxCoeff() < 1e-9);
    CHECK((read.values - planted.values).norm() < 1e-5 * planted.values.norm());
  }
}

TEST_CASE("responses are told from recordings by what the file holds",
          "[analysis][responses][formats]") {
  const testing::TempDirectory directory;
  const FrequencyResponses planted = few_lines();
  const std::string record = testing::universal_function(planted, 0, 1);
  const std::vector<std::pair<NamedText, bool>> files{
      {{"responses.uff", testing::universal_file(planted)}, true},
      {{"both.uff", testing::universal_file(planted) + record}, false},
      {{"responses.csv", table_of(planted, false)}, true},
      {{"taps.csv", "time_s,acc\n0,1\n"}, false}};
  for (const auto& [file, holds] : files) {
    CAPTURE(file.name);
    testing::write(directory / file.name, file.text);
    CHECK(holds_responses(directory / file.name) == holds);
  }
}

TEST_CASE("five decimals of an instrument cost no more than five digits of a pole",
          "[analysis][responses]") {
  const auto planted = testing::planted_responses(two_places, ResponseKind::accelerance,
                                                  {0.0, 120.0}, 241);  // with a line at 0 Hz
  auto whole = planted;
  whole.values.row(0).setZero();
  const auto found =
      find_response_modes(read_text({"a.uff", testing::universal_file(whole)}, {}), {});
  REQUIRE(found.modes.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(found.modes[i].frequency_hz.value ==
          Approx(two_places.poles[i].frequency_hz).epsilon(1e-5));
    CHECK(found.modes[i].damping_ratio.value ==
          Approx(two_places.poles[i].damping_ratio).epsilon(1e-4));
  }
}

TEST_CASE("spectra and coherences beside responses are left out and told",
          "[analysis][responses][formats]") {
  const FrequencyResponses planted = few_lines();
  const std::string coherence = testing::universal_function(planted, 1, 6);
  const auto read = read_text({"a.uff", testing::universal_file(planted) + coherence}, {});
  CHECK(read.pairs == planted.pairs);
  REQUIRE(read.remarks.size() == 1);
  CHECK_THAT(read.remarks.front(), Contains("left out: 1 of kind coherence"));
  CHECK_THROWS_WITH(read_text({"a.uff", coherence}, {}),
                    Contains("no frequency response") && Contains("coherence"));
}

TEST_CASE("a last line of responses that has no line end is left out and named",
          "[analysis][responses][formats]") {
  const FrequencyResponses planted = few_lines();
  const std::string table = table_of(planted, false);
  const FrequencyResponses read =
      read_text({"a.csv", table.substr(0, table.size() - 3)}, planted.kind);
  CHECK(read.values.rows() == planted.values.rows() - 1);
  REQUIRE(read.remarks.size() == 1);
  CHECK_THAT(read.remarks.front(), Contains("a.csv: line 32 is left out"));
}

TEST_CASE("responses that cannot be told are refused in one sentence",
          "[analysis][responses][formats]") {
  const FrequencyResponses planted = few_lines();
  const std::string first = testing::universal_function(planted, 0);
  const std::string second = testing::universal_function(planted, 1);
  FrequencyResponses finer = planted;
  finer.frequency_hz = 0.5 * planted.frequency_hz;
  FrequencyResponses accelerance = planted;
  accelerance.kind = ResponseKind::accelerance;
  const std::string table = table_of(planted, false);
  const auto changed = [](const std::string& text, const std::string& from, const std::string& to) {
    return testing::replaced(text, from, to);
  };
  struct Refused {
    NamedText file;
    std::string says;
    std::optional<ResponseKind> kind{};
  };
  const std::vector<Refused> all{
      {{"a.uff", first + first}, "is there twice"},
      {{"a.uff", first + testing::universal_function(finer, 1)}, "all must have the same"},
      {{"a.uff", first + testing::universal_function(accelerance, 1)}, "all must be one"},
      {{"a.uff", first.substr(0, first.size() - 60)}, "cut off"},
      {{"a.uff", changed(first, "NONE               1   3\n", "\n")}, "of its reference"},
      {{"a.uff", changed(first, "        31         1", "        31         0")}, "even steps"},
      {{"a.uff", changed(first, "        13    0    0    0", "        12    0    0    0")},
       "is no force"},
      {{"a.uff", first + second}, "--response receptance", ResponseKind::receptance},
      {{"a.uff", changed(first, "        11    0    0    0", "         0    0    0    0")},
       "does not say what its responses are"},
      {{"a.csv", table}, "does not say what its responses are"},
      {{"a.csv", changed(table, "2+Z/1+Z imag", "2+Z/1+Z phase_deg")},
       "has no column '2+Z/1+Z imag'"},
      {{"a.csv", changed(table, "2+Z/1+Z imag", "coherence")}, "'coherence' is no header"},
      {{"a.csv", table_of(planted, true, 1.0)}, "as radians would be", planted.kind},
      {{"a.csv", table_of(planted, true, degrees, -1.0)},
       "a magnitude is not below 0",
       planted.kind},
      {{"a.csv", changed(table, "\n20,", "\n18,")}, "do not ascend", planted.kind},
      {{"a.csv", changed(table, "\n20,", "\n20,nan,")}, "a.csv:12:", planted.kind}};
  for (const Refused& refused : all) {
    CAPTURE(refused.says);
    CHECK_THROWS_WITH(read_text(refused.file, refused.kind), Contains(refused.says));
  }
}
