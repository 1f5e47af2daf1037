// Files that are cut off, empty, of no rate or of values that are none: refused, or said.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "analysis/modal/recording/recording.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/reference_programs.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
constexpr int whole_count = 90;

int whole_sample(int i) {
  return 1000 + 37 * i;  // each has four digits: a part of one is another number
}

std::string column_of(const std::string& separator, const std::string& end_of_row) {
  std::string text;
  for (int i = 0; i < whole_count; ++i) {
    text += separator.empty() ? fmt::format("{}", whole_sample(i))
                              : fmt::format("{}{}{}", 0.0625 * i, separator, whole_sample(i));
    text += end_of_row;
  }
  return text;
}

std::string universal_text() {
  std::string text = fmt::format(
      "    -1\n    58\nNONE\nNONE\nNONE\nNONE\nNONE\n"
      "         1         0    0         0 NONE               7   3 NONE               1   3\n"
      "         4{:>10}         1{:>13.5E}{:>13.5E}{:>13.5E}\n",
      whole_count, 0.0, 0.0625, 0.0);
  for (int i = 0; i < 4; ++i) {
    text += "        12    0    0    0 NONE                 NONE\n";
  }
  for (int i = 0; i < whole_count; ++i) {
    text += fmt::format("{:>20}{}", whole_sample(i), i % 4 == 3 ? "\n" : "");
  }
  return text + "\n    -1\n";
}

template <class Number>
std::string bytes_of(Number value) {
  std::array<char, sizeof(Number)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(Number));
  return {bytes.data(), bytes.size()};
}

std::string sound_of(std::uint32_t rate_hz, const std::string& data, std::uint16_t format,
                     std::uint16_t bits) {
  return "RIFF" + bytes_of(static_cast<std::uint32_t>(36 + data.size())) + "WAVEfmt " +
         bytes_of<std::uint32_t>(16) + bytes_of(format) + bytes_of<std::uint16_t>(1) +
         bytes_of(rate_hz) + bytes_of(rate_hz * bits / 8) +
         bytes_of(static_cast<std::uint16_t>(bits / 8)) + bytes_of(bits) + "data" +
         bytes_of(static_cast<std::uint32_t>(data.size())) + data;
}

std::string whole_sound() {
  std::string data;
  for (int i = 0; i < whole_count; ++i) {
    data += bytes_of(static_cast<std::int16_t>(whole_sample(i)));
  }
  return sound_of(16, data, 1, 16);
}

// What SciPy and h5py write of the same samples and their rate.
std::string matlab_of(const testing::TempDirectory& directory, const std::string& how) {
  const std::string file = directory / "whole.mat";
  testing::python_numbers(
      "import h5py\nfrom scipy.io import savemat\nx = 1000.0 + 37 * np.arange(90)\nfile = '" +
      file + "'\n" + how + "\nout(x)\n");
  return testing::contents(file);
}
// MATLAB's own names of classes end where their bytes do, which h5py does not write by itself.
const std::string matlab_7_3 =
    "name_type = h5py.h5t.C_S1.copy()\nname_type.set_size(6)\n"
    "with h5py.File(file, 'w', userblock_size=512) as f:\n"
    "  for name, value in (('acc', x.reshape(1, 90)), ('fs', np.full((1, 1), 16.0))):\n"
    "    a = h5py.h5a.create(f.create_dataset(name, data=value).id, b'MATLAB_class', name_type,\n"
    "                        h5py.h5s.create(h5py.h5s.SCALAR))\n"
    "    a.write(np.array(b'double', dtype='S6'), mtype=name_type)\n"
    "with open(file, 'r+b') as f:\n"
    "  f.write(b'MATLAB 7.3 MAT-file'.ljust(116) + bytes(8) + b'\\0\\2IM')\n";

struct CutFile {
  std::string name;
  std::string bytes;
  bool ends_in_itself{true};  // so that a whole file is told from a cut one
};

struct Told {
  std::vector<double> samples;
  bool is_said{};
};
Told read_part(const testing::TempDirectory& directory, const std::string& name,
               const std::string& bytes) {
  const std::string file = directory / name;
  testing::write(file, bytes);
  ReadingOptions options;
  options.rate_hz = 16.0;
  options.column = name == "blanks.txt" ? "2" : "";
  try {
    Recording recording = read_recording(file, options);
    return {std::move(recording.samples), !recording.remarks.empty()};
  } catch (const core::InvalidInput& error) {
    CHECK_THAT(error.what(), Contains(name));
    return {{}, true};
  }
}

void check_cuts(const testing::TempDirectory& directory, const CutFile& file) {
  const Told whole = read_part(directory, file.name, file.bytes);
  CHECK_FALSE(whole.is_said);
  REQUIRE(whole.samples.size() == whole_count);
  const std::size_t step = file.bytes.size() / 150 + 1;
  for (std::size_t cut = 0; cut + 1 < file.bytes.size(); cut += step) {
    CAPTURE(file.name, cut);
    const Told part = read_part(directory, file.name, file.bytes.substr(0, cut));
    CHECK(std::ranges::equal(
        part.samples, std::vector<double>(whole.samples.begin(),
                                          whole.samples.begin() + std::ssize(part.samples))));
    CHECK((part.is_said || !file.ends_in_itself));
  }
}
}  // namespace

TEST_CASE("no number of a file that is cut anywhere is another than in the whole file",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  check_cuts(directory, {"one.csv", column_of("", "\n"), false});
  check_cuts(directory, {"two.csv", "time,acc\n" + column_of(",", "\r\n"), false});
  check_cuts(directory, {"blanks.txt", column_of("  ", "\n"), false});
  check_cuts(directory, {"text.uff", universal_text()});
  check_cuts(directory, {"taps.wav", whole_sound()});
  const std::string both = "savemat(file, {'acc': x, 'fs': 16.0}, format=";
  check_cuts(directory, {"plain.mat", matlab_of(directory, both + "'5')")});
  check_cuts(directory, {"packed.mat", matlab_of(directory, both + "'5', do_compression=True)")});
  check_cuts(directory, {"old.mat", matlab_of(directory, both + "'4')"), false});
  check_cuts(directory, {"new.mat", matlab_of(directory, matlab_7_3)});
  const std::string hdf5 = "with h5py.File(file, 'w') as f:\n  f['acc'] = x; f['fs'] = 16.0";
  check_cuts(directory, {"taps.h5", matlab_of(directory, hdf5)});
}

TEST_CASE("a last line without a line end is left out and named", "[analysis][recordings]") {
  const testing::TempDirectory directory;
  const std::string text = column_of("", "\n");
  testing::write(directory / "one.csv", text.substr(0, text.size() - 2));
  ReadingOptions options;
  options.rate_hz = 8.0;
  const Recording recording = read_recording(directory / "one.csv", options);
  CHECK(recording.samples.size() == whole_count - 1);
  REQUIRE(recording.remarks.size() == 1);
  CHECK_THAT(recording.remarks.front(), Contains("line 90 is left out"));
}

TEST_CASE("a sound file of no rate, no sample or of what is no number is refused in one sentence",
          "[analysis][recordings]") {
  const testing::TempDirectory directory;
  const std::string samples = whole_sound().substr(44);
  std::string floats;
  for (int i = 0; i < whole_count; ++i) {
    floats += bytes_of(i == 4 ? std::numeric_limits<float>::quiet_NaN() : 0.5F);
  }
  const std::vector<std::pair<std::string, std::string>> refused{
      {sound_of(0, samples, 1, 16), "its header states a rate of 0"},
      {sound_of(8, "", 1, 16), "has 0 samples (at least 64)"},
      {sound_of(8, floats, 3, 32), "sample 5 of channel 1 is nan"},
      {"", "cannot be read as sound"}};
  for (const auto& [bytes, says] : refused) {
    CAPTURE(says);
    testing::write(directory / "taps.wav", bytes);
    CHECK_THROWS_WITH(read_recording(directory / "taps.wav", {}), Contains(says));
  }
}

TEST_CASE("a universal file that states absurdly many values is refused",
          "[analysis][recordings]") {
  const testing::TempDirectory directory;
  const std::string many =
      testing::replaced(universal_text(), "        90         1", " 9223372036854775808 1");
  testing::write(directory / "many.uff", many);
  CHECK_THROWS_WITH(read_recording(directory / "many.uff", {}), Contains("many.uff:9: states"));
}

TEST_CASE("a MATLAB file of version 7.3 that is cut off is refused in one sentence of ours",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string whole = matlab_of(directory, matlab_7_3);
  testing::write(directory / "cut.mat", whole.substr(0, whole.size() / 2));
  const auto run = testing::tapstudy({"identify", directory / "cut.mat", "--out", directory / "o"});
  CHECK(run.exit_code == 2);
  CHECK(std::ranges::count(run.standard_error, '\n') == 1);
  CHECK_THAT(run.standard_error, Contains("cut.mat: cannot be read as a MATLAB file"));
}
