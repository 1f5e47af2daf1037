// Recordings in the formats of instruments and of other programs.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>

#include "analysis/modal/recording/instrument_table.hpp"
#include "analysis/modal/recording/measured_unit.hpp"
#include "analysis/modal/recording/recording.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
constexpr int count = 80;
constexpr double rate_hz = 2000.0;

double sample_at(int i) {
  return std::round(1000.0 * std::sin(0.3 * i)) / 1024.0;  // exact in single precision
}

// Rows of time and value.
std::string rows_of(const std::string& separator, double units_per_s) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += fmt::format("{:.6g}{}{:.9g}\n", i / rate_hz * units_per_s, separator, sample_at(i));
  }
  return text;
}

std::string with_decimal_commas(std::string text) {
  std::ranges::replace(text, '.', ',');
  return text;
}

Recording read_text(const std::string& text, const ReadingOptions& options) {
  std::istringstream stream{text};
  return read_csv_recording(stream, "taps.csv", options);
}

void check_samples(const Recording& recording) {
  CHECK(recording.rate_hz == Approx(rate_hz));
  REQUIRE(recording.samples.size() == count);
  for (int i = 0; i < count; ++i) {
    CHECK(recording.samples[static_cast<std::size_t>(i)] == Approx(sample_at(i)));
  }
}
}  // namespace

TEST_CASE("a table of an instrument is a recording whatever stands above its numbers",
          "[analysis][recordings][formats]") {
  const auto text = GENERATE(values<std::string>({
      rows_of(" ", 1.0),
      "# Created by Octave 8\n# name: x\n# rows: 80\n" + rows_of("   ", 1.0),
      "# time acc\n" + rows_of(" ", 1.0),
      "Zeit [s];acc\n" + with_decimal_commas(rows_of(";", 1.0)),
      "timestamp_us,acc\n" + rows_of(",", 1e6),
      "Time Stamp (us),acc\n" + rows_of(",", 1e6),
      "Elapsed Time,acc\n" + rows_of(",", 1.0),
      "millis,acc\n" + rows_of(",", 1000.0),
      "Time (milliseconds),acc\n" + rows_of(",", 1000.0),
      "x-axis,1\nsecond,Volt\n" + rows_of(",", 1.0),
      "Time,Acceleration\ns,m/s^2\n" + rows_of(",", 1.0),
      "Run 3\n\nTime\tAcceleration\n(ms)\t(g)\n" + rows_of("\t", 1000.0),
      "Zeit (ms);Beschleunigung\nms;g\n" + with_decimal_commas(rows_of(";", 1000.0)),
      "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\nDelta_X\t0,0005\n"
      "***End_of_Header***\t\nX_Value\tAcc\tComment\n" +
          with_decimal_commas(rows_of("\t", 1.0)),
  }));
  CAPTURE(text.substr(0, 60));
  check_samples(read_text(text, {}));
}

namespace {
// As LabVIEW writes two channels without their times; the intervals between samples as stated.
std::string labview_without_times(char separator, const std::string& intervals_s) {
  std::string text =
      "LabVIEW Measurement|\nWriter_Version|2\nSeparator|Tab\nX_Columns|No\n"
      "***End_of_Header***|\n|\nChannels|2||\nY_Unit_Label|g|N|\nX0|0.5|0.5|\nDelta_X|" +
      intervals_s + "|\n***End_of_Header***|||\n|Acc|Force|Comment\n";
  for (int i = 0; i < count; ++i) {
    text += fmt::format("|{:.9g}|{}\n", sample_at(i), i % 7);
  }
  std::ranges::replace(text, '|', separator);
  return text;
}
}  // namespace

TEST_CASE("samples without times are as far apart as the header of LabVIEW's file says",
          "[analysis][recordings][formats]") {
  const bool has_commas = GENERATE(false, true);
  std::string text = labview_without_times(has_commas ? '\t' : ',', "0.0005|0.0005");
  ReadingOptions options;
  options.column = "Acc";
  const Recording acc = read_text(has_commas ? with_decimal_commas(text) : text, options);
  check_samples(acc);
  CHECK_THAT(why_not_si(acc, Quantity::acceleration), Contains("--scale 9.80665"));
  // of channels with rates of their own none is the table's
  text = labview_without_times(',', "0.0005|0.001");
  CHECK_THROWS_WITH(read_text(text, options), Contains("--rate"));
  options.rate_hz = rate_hz;
  const Recording given = read_text(text, options);
  check_samples(given);
  CHECK_THAT(why_not_si(given, Quantity::acceleration), Contains("--scale 9.80665"));
}

namespace {
std::string as_utf16(const std::string& ascii) {
  std::string text = "\xff\xfe";
  for (const char c : ascii) {
    text += {c, '\0'};
  }
  return text;
}
}  // namespace

TEST_CASE("a table in Windows-1252 or UTF-16 is read with its units, and that is said",
          "[analysis][recordings][formats]") {
  const Recording windows = read_text(
      "Messgr\xf6\xdf"
      "e\r\n\r\nZeit (s)\tAcc (m/s\xb2)\n" +
          with_decimal_commas(rows_of("\t", 1.0)),
      {});
  check_samples(windows);
  CHECK(windows.channel == "Acc (m/s\u00b2)");
  CHECK(why_not_si(windows, Quantity::acceleration).empty());
  REQUIRE(windows.remarks.size() == 1);
  CHECK_THAT(windows.remarks.front(), Contains("not UTF-8") && Contains("windows-1252"));
  const Recording wide = read_text(as_utf16("time (s),acc (g)\n" + rows_of(",", 1.0)), {});
  check_samples(wide);
  CHECK_THAT(why_not_si(wide, Quantity::acceleration), Contains("--scale 9.80665"));
  REQUIRE(wide.remarks.size() == 1);
  CHECK_THAT(wide.remarks.front(), Contains("UTF-16"));
  CHECK_THROWS_WITH(read_text("time,acc\x81\n" + rows_of(",", 1.0), {}),
                    Contains("taps.csv: is not text in UTF-8 nor windows-1252"));
}

TEST_CASE("of a LabVIEW file with a header for each segment the first is read, and that is said",
          "[analysis][recordings][formats]") {
  const bool has_comments = GENERATE(true, false);
  const bool has_times = GENERATE(true, false);
  const std::string name = has_comments ? "\tComment\n" : "\n";
  const auto segment = [&](int gain) {
    std::string text =
        "Channels\t1\t\nY_Unit_Label\tg\t\nX0\t0\t\nDelta_X\t0.0005\t\n"
        "***End_of_Header***\t\t\n";
    text += (has_times ? "X_Value" : "") + std::string{"\tAcc"} + name;
    for (int i = 0; i < count; ++i) {
      text += fmt::format("{}\t{:.9g}\n", has_times ? fmt::format("{:.6g}", i / rate_hz) : "",
                          gain * sample_at(i));
    }
    return text;
  };
  const std::string file = fmt::format(
      "LabVIEW Measurement\t\nSeparator\tTab\nX_Columns\t{}\n***End_of_Header***\t\n\t\n",
      has_times ? "One" : "No");
  const Recording one = read_text(file + segment(1), {});
  check_samples(one);
  CHECK(one.remarks.empty());
  const Recording several =
      read_text(file + segment(1) + "\t\n" + segment(2) + "\t\n" + segment(3), {});
  check_samples(several);
  CHECK(several.channel == one.channel);
  CHECK(several.unit == "g");
  REQUIRE(several.remarks.size() == 1);
  CHECK_THAT(several.remarks.front(),
             Contains("3 segments") && Contains("only the first") && Contains("line 91"));
}

TEST_CASE("dates, gaps and an oscilloscope's settings in a table are refused with what helps",
          "[analysis][recordings][formats]") {
  std::string dates = "time,acc\n";
  std::string settings;
  for (int i = 0; i < count; ++i) {
    dates += fmt::format("2026-05-01T10:00:{:02}.000,{:.9g}\n", i % 60, sample_at(i));
    settings +=
        fmt::format("{},{:.6f},{:.6f}\n", i == 0 ? "Record Length" : "", i / rate_hz, sample_at(i));
  }
  CHECK_THROWS_WITH(read_text(dates, {}), Contains("taps.csv:2:") && Contains("--rate HZ"));
  ReadingOptions given;
  given.rate_hz = rate_hz;
  given.column = "acc";
  check_samples(read_text(dates, given));
  given.column = "1";
  CHECK_THROWS_WITH(read_text(settings, given), Contains("oscilloscope"));
  CHECK_THROWS_WITH(read_text("t,acc\n" + rows_of(",", 1e6), {}),  // of no unit
                    Contains("taps.csv:2:") && Contains("500 s apart") && Contains("time_us"));
  CHECK_THROWS_WITH(read_text("time,acc\n" + rows_of(",", 1e3), {}),  // likewise
                    Contains("taps.csv:2:") && Contains("0.5 s apart") && Contains("time_ms"));
  const std::string slow = "acc\n" + rows_of(",", 100.0);
  CHECK_THROWS_WITH(read_text("time," + slow, {}),  // of no unit: milliseconds at 20 kHz look so
                    Contains("taps.csv:2:") && Contains("0.05 s apart") && Contains("time_s"));
  CHECK(read_text("time_s," + slow, {}).rate_hz == Approx(20.0));
  given.column = "acc";
  const std::string gap = testing::replaced(
      "t,acc\n" + rows_of(",", 1.0), fmt::format("\n0.002,{:.9g}", sample_at(4)), "\n0.002,nan");
  CHECK_THROWS_WITH(read_text(gap, given),
                    Contains("taps.csv:6:") && Contains("a sample is missing"));
}

TEST_CASE("a channel's unit is SI, or --scale or --quantity is asked for",
          "[analysis][recordings][formats]") {
  struct Stated {
    const char* channel;
    Quantity quantity;
    const char* asked;
  };
  // 9.80665 m/s² is standard gravity by definition
  const auto [channel, quantity, asked] = GENERATE(values<Stated>({
      {"Acc (g)", Quantity::acceleration, "--scale 9.80665"},
      {"acc_g", Quantity::acceleration, "--scale 9.80665"},
      {"Beschleunigung [mm/s\u00b2]", Quantity::acceleration, "--scale 0.001"},
      {"laser [\u00b5m]", Quantity::displacement, "--scale 1e-06"},
      {"velocity_mm_s", Quantity::velocity, "--scale 0.001"},
      {"velocity_mm_s", Quantity::acceleration, "no acceleration (--quantity velocity)"},
      {"Voltage (mV)", Quantity::acceleration, "--scale says what one is"},
      {"Acc (m/s^2)", Quantity::acceleration, ""},
      {"acc_m_s2", Quantity::acceleration, ""},
      {"acc", Quantity::acceleration, ""},
      {"thing", Quantity::acceleration, ""},
      {"Acc (left)", Quantity::acceleration, ""},
  }));
  CAPTURE(channel);
  const std::string why = why_not_si({"a.csv", channel, 1000.0, {}, {}}, quantity);
  CHECK(why.empty() == std::string{asked}.empty());
  CHECK_THAT(why, Contains(asked));
  CHECK_THAT(why_not_si({"a.wav", "channel 1", 1000.0, {}, {}, full_scale}, quantity),
             Contains("full scale"));
}

TEST_CASE("units that a table states below its names, or LabVIEW in a line, are its channel's",
          "[analysis][recordings][formats]") {
  struct Stated {
    std::string above;
    double units_per_s;
    char separator;
    const char* asked;
  };
  const std::string labview =
      "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\t\nChannels\t1\t\n";
  const auto stated = GENERATE_COPY(values<Stated>({
      {"Time,Channel A\ns,g\n", 1.0, ',', "--scale 9.80665"},
      {"Time,Channel A\n[s],[g]\n", 1.0, ',', "--scale 9.80665"},
      {"Time,Channel A\n(ms),(g)\n\n", 1e3, ',', "--scale 9.80665"},
      {"Time (ms),Channel A (g)\n\n", 1e3, ',', "--scale 9.80665"},
      {"# Time Channel\n# ms g\n", 1e3, ' ', "--scale 9.80665"},
      {"Time,Channel A\n(s),(mm/s)\n", 1.0, ',', "(--quantity velocity)"},
      {"Time,Channel A\n(s),(V)\n", 1.0, ',', "--scale says what one is"},
      {"x-axis,1\nsecond,Volt\n", 1.0, ',', "--scale says what one is"},
      {"Time,Channel A\n(s),(m/s^2)\n", 1.0, ',', ""},
      {labview + "Y_Unit_Label\tg\nX_Value\tAcc\tComment\n", 1.0, '\t', "--scale 9.80665"},
      {labview + "Y_Unit_Label\tVolts\nX_Value\tAcc\tComment\n", 1.0, '\t', "--scale says"},
  }));
  CAPTURE(stated.above);
  const Recording recording =
      read_text(stated.above + rows_of(std::string(1, stated.separator), stated.units_per_s), {});
  check_samples(recording);
  const std::string why = why_not_si(recording, Quantity::acceleration);
  CHECK(why.empty() == std::string{stated.asked}.empty());
  CHECK_THAT(why, Contains(stated.asked));
}

TEST_CASE("units are a column's own, and its name stays without them, also where no time is",
          "[analysis][recordings][formats]") {
  std::string text = "Acc,Force\n(g),(N)\n";
  for (int i = 0; i < count; ++i) {
    text += fmt::format("{:.9g},{}\n", sample_at(i), i);
  }
  ReadingOptions options;
  options.rate_hz = rate_hz;
  options.column = "Acc";
  const Recording acc = read_text(text, options);
  check_samples(acc);
  CHECK_THAT(why_not_si(acc, Quantity::acceleration), Contains("values of Acc are in g"));
  options.column = "Force";
  CHECK(why_not_si(read_text(text, options), Quantity::acceleration).empty());
}

TEST_CASE("a rate given beside another one is refused, or taken and said if it is to be trusted",
          "[analysis][recordings][formats]") {
  const std::string text = "time,acc\n" + rows_of(",", 1.0);
  ReadingOptions options;
  options.rate_hz = 1900.0;
  CHECK_THROWS_WITH(read_text(text, options), Contains("--trust-rate"));
  options.trusts_rate = true;
  const Recording recording = read_text(text, options);
  CHECK(recording.rate_hz == 1900.0);
  REQUIRE(recording.remarks.size() == 1);
  CHECK_THAT(recording.remarks.front(), Contains("2000") && Contains("1900"));
}

TEST_CASE("times that are rounded to whole milliseconds give way to a rate that is trusted",
          "[analysis][recordings][formats]") {
  std::string text = "time_ms,acc\n";
  for (int i = 0; i < 200; ++i) {
    text += fmt::format("{},{:.9g}\n", i * 1000 / 1600, sample_at(i));
  }
  ReadingOptions options;
  CHECK_THROWS_WITH(read_text(text, options), Contains("--rate HZ --trust-rate"));
  options.rate_hz = 1600.0;
  CHECK_THROWS_WITH(read_text(text, options), Contains("--rate HZ --trust-rate"));
  options.trusts_rate = true;
  const Recording recording = read_text(text, options);
  CHECK(recording.rate_hz == 1600.0);
  CHECK(recording.samples.size() == 200);
  REQUIRE(recording.remarks.size() == 1);
  CHECK_THAT(recording.remarks.front(),
             Contains("periods from a uniform grid: 1600 samples a second were taken"));
}

namespace {
// A data set 58 as the format's description lays it out, without its values.
std::string header_58(const std::string& kind, int function_type, int value_type, int node,
                      const std::string& unit = "m/s^2") {
  return fmt::format(
      "    -1\n{}\nNONE\nNONE\nNONE\nNONE\nNONE\n"
      "{:>5}{:>10}{:>5}{:>10} {:<10}{:>10}{:>4} {:<10}{:>10}{:>4}\n"
      "{:>10}{:>10}{:>10}{:>13.5E}{:>13.5E}{:>13.5E}\n"
      "        17    0    0    0 Time                 s\n"
      "        12    0    0    0 Acc                  {}\n"
      "         0    0    0    0 NONE                 NONE\n"
      "         0    0    0    0 NONE                 NONE\n",
      kind, function_type, 0, 0, 0, "NONE", node, 3, "NONE", 1, 3, value_type, count, 1, 0.0,
      1.0 / rate_hz, 0.0, unit);
}

std::string in_text(int value_type) {
  std::string text;
  const int a_line = value_type == 2 ? 6 : 4;
  for (int i = 0; i < count; ++i) {
    text += value_type == 2 ? fmt::format("{:>13.5E}", sample_at(i))
                            : fmt::format("{:>20.12E}", sample_at(i));
    text += i % a_line == a_line - 1 || i == count - 1 ? "\n" : "";
  }
  return text;
}

template <class Float>
std::string in_bytes(bool is_big_endian) {
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    const auto value = static_cast<Float>(sample_at(i));
    std::array<char, sizeof(Float)> of_value{};
    std::memcpy(of_value.data(), &value, sizeof(Float));
    if (is_big_endian != (std::endian::native == std::endian::big)) {
      std::ranges::reverse(of_value);
    }
    bytes.append(of_value.data(), of_value.size());
  }
  return bytes;
}

std::string binary_58(int value_type, bool is_big_endian, int node) {
  const std::string bytes =
      value_type == 2 ? in_bytes<float>(is_big_endian) : in_bytes<double>(is_big_endian);
  const std::string kind = fmt::format("    58b{:>6}{:>6}{:>12}{:>12}{:>6}{:>6}{:>12}{:>12}",
                                       is_big_endian ? 2 : 1, 2, 11, bytes.size(), 0, 0, 0, 0);
  return header_58(kind, 1, value_type, node) + bytes + "\n    -1\n";
}

std::string written(const testing::TempDirectory& directory, const std::string& name,
                    const std::string& bytes) {
  testing::write(directory / name, bytes);
  return directory / name;
}
}  // namespace

TEST_CASE("time records of universal files are the same in text and bytes of either order",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string units = "    -1\n   164\n         1SI\n    -1\n";
  const auto data = GENERATE(values<std::string>(
      {header_58("    58", 1, 2, 7) + in_text(2) + "    -1\n",
       header_58("    58", 1, 4, 7) + in_text(4) + "    -1\n", binary_58(2, false, 7),
       binary_58(2, true, 7), binary_58(4, false, 7), binary_58(4, true, 7)}));
  const std::string file = written(directory, "taps.uff", units + data);
  const Recording recording = read_recording(file, {});
  CHECK(recording.channel == "7+Z");
  REQUIRE(recording.samples.size() == count);
  CHECK(recording.rate_hz == Approx(rate_hz));
  for (int i = 0; i < count; ++i) {
    CHECK(recording.samples[static_cast<std::size_t>(i)] == Approx(sample_at(i)).margin(1e-5));
  }
}

TEST_CASE("the unit of a universal file's record is its channel's",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const auto why_not = [&](const std::string& record) {
    return why_not_si(
        read_recording(written(directory, "taps.uff", record + in_text(2) + "    -1\n"), {}),
        Quantity::acceleration);
  };
  const std::string in_g = header_58("    58", 1, 2, 7, "g");
  CHECK_THAT(why_not(in_g), Contains("values of 7+Z are in g: --scale 9.80665"));
  CHECK_THAT(why_not(testing::replaced(in_g, "0 Acc                  g", "0 Acc g")),
             Contains("--scale 9.80665"));
  CHECK(why_not(header_58("    58", 1, 2, 7)).empty());
  CHECK(why_not(header_58("    58", 1, 2, 7, "NONE")).empty());
}

TEST_CASE("of several data sets one is chosen, and what is no time record is refused in words",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string record = header_58("    58", 1, 2, 7) + in_text(2) + "    -1\n";
  const std::string response = header_58("    58", 4, 2, 8) + in_text(2) + "    -1\n";
  ReadingOptions chosen;
  chosen.column = "9+Z";
  const std::string two =
      written(directory, "two.uff", record + response + binary_58(4, true, 9) + record);
  CHECK(read_recording(two, chosen).channel == "9+Z");
  CHECK_THROWS_WITH(read_recording(two, {}), Contains("has 3 time records"));
  CHECK_THROWS_WITH(read_recording(written(directory, "f.uff", response), {}),
                    Contains("frequency responses"));
  CHECK_THROWS_WITH(
      read_recording(written(directory, "cut.uff", record.substr(0, record.size() - 60)), {}),
      Contains("cut off"));
  const std::string bytes = binary_58(4, false, 7);
  CHECK_THROWS_WITH(
      read_recording(written(directory, "cutb.uff", bytes.substr(0, bytes.size() - 60)), {}),
      Contains("cut off"));
  CHECK_THROWS_WITH(read_recording(written(directory, "no.uff", "nothing\n"), {}),
                    Contains("holds no data set 58"));
}

namespace {
// Has SciPy save variables, as Python writes them, of a signal x, which is returned.
std::vector<double> saved_by_scipy(
    const std::vector<std::pair<std::string, std::string>>& variables_of_file) {
  std::string script =
      "from scipy.io import savemat\nx = np.round(1000 * np.sin(0.3 * np.arange(80)))\n";
  for (const auto& [file, variables] : variables_of_file) {
    script += "savemat('" + file + "', {" + variables + "})\n";
  }
  return testing::python_numbers(script + "out(x)\n");
}
}  // namespace

TEST_CASE("arrays of a MATLAB file are what SciPy wrote, and no sound",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.mat";
  const auto values = saved_by_scipy(
      {{file, "'unit': 'g', 'n': 3.0, 'acc': x, 'two': np.vstack([x, 2 * x]).astype(np.int16)"},
       {directory / "rate.mat", "'acc': x.astype(np.float32), 'Fs': 2000.0"},
       {directory / "times.mat", "'acc': x, 't': np.arange(80) / 2000"},
       {directory / "small.mat", "'acc': x[:9]"},
       {directory / "0.mat", "'acc': x, 'fs': 0.0"},
       {directory / "-2000.mat", "'acc': x, 'fs': -2000.0"},
       {directory / "nan.mat", "'acc': x, 'fs': np.nan"},
       {directory / "inf.mat", "'acc': x, 'fs': np.inf"}});
  ReadingOptions options;
  CHECK_THROWS_WITH(read_recording(file, options),
                    Contains("has 3 channels") && Contains("acc, two:1, two:2"));
  options.column = "two:2";
  CHECK_THROWS_WITH(read_recording(file, options), Contains("--rate HZ"));
  options.rate_hz = rate_hz;
  const Recording second = read_recording(file, options);
  REQUIRE(second.samples.size() == values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(second.samples[i] == 2.0 * values[i]);
  }
  for (const std::string name : {"rate.mat", "times.mat"}) {
    const Recording recording = read_recording(directory / name, {});
    CHECK(recording.rate_hz == Approx(rate_hz));
    CHECK(recording.samples == values);
  }
  CHECK_THROWS_WITH(read_recording(directory / "small.mat", {}), Contains("no real numeric array"));
  for (const std::string rate : {"0", "-2000", "nan", "inf"}) {
    const std::string name = directory / (rate + ".mat");
    CHECK_THROWS_WITH(read_recording(name, {}), Contains("says " + rate + " samples a second"));
  }
  testing::write(directory / "no.mat", "this is no array");
  CHECK_THROWS_WITH(read_recording(directory / "no.mat", {}), Contains("MATLAB"));
}

TEST_CASE("times and a scalar of a MATLAB file that contradict each other are refused",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.mat";
  saved_by_scipy({{file, "'acc': x, 't': np.arange(80) / 2000, 'fs': 1000.0"},
                  {directory / "same.mat", "'acc': x, 't': np.arange(80) / 2000, 'fs': 2000.5"}});
  CHECK_THROWS_WITH(read_recording(file, {}),
                    Contains("its times t say 2000 samples a second, its scalar fs 1000") &&
                        Contains("--trust-rate"));
  ReadingOptions options;
  options.rate_hz = rate_hz;
  options.trusts_rate = true;
  CHECK(read_recording(file, options).rate_hz == rate_hz);
  CHECK(read_recording(directory / "same.mat", {}).rate_hz == Approx(rate_hz));
}

TEST_CASE(
    "an array in a structure of a MATLAB file is named with it, its rate is the one beside it",
    "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "nested.mat";
  const auto values = saved_by_scipy({{file,
                                       "'fs': 100.0, 'shaker': {'acc': -x, 'fs': 500.0}, "
                                       "'hammer': {'plate': {'acc': x, 'fs': 2000.0}}"}});
  ReadingOptions options;
  CHECK_THROWS_WITH(read_recording(file, options), Contains("shaker.acc, hammer.plate.acc"));
  options.column = "hammer.plate.acc";
  const Recording recording = read_recording(file, options);
  CHECK(recording.rate_hz == Approx(rate_hz));
  CHECK(recording.samples == values);
}

TEST_CASE("an array of an HDF5 file is what h5py wrote, with the nearest rate",
          "[analysis][recordings][formats]") {
  const std::string write = GENERATE(
      as<std::string>{}, "f['acc'] = x; f['fs'] = 2000",
      "f['acc'] = x.astype('>f4'); f['acc'].attrs['Sampling Rate (Hz)'] = np.float32(2000)",
      "f['acc'] = (8 * x).astype('<i2') / 8; f.attrs['dt'] = 0.0005",
      "f.create_dataset('acc', data=x, chunks=(7,), compression='gzip', shuffle=True)\n"
      "f['time_ms'] = np.arange(80) / 2",
      "f.create_dataset('acc', data=x, dtype='<f8'); f['fs'] = 2000.0; f['name'] = 'plate'\n"
      "f['z'] = x + 1j * x; f['cube'] = np.zeros((80, 80, 2)); f['loop'] = f['/']",
      "f['data'] = np.stack([-x, x], 1); f['data'].attrs['fs'] = 2000",
      "f['data'] = np.stack([-x, x]); f.attrs['sample_rate_hz'] = np.array([2000])",
      "f['fs'] = 9; g = f.create_group('a/b'); g['acc'] = x; g.attrs['fs'] = 2000\n"
      "o = f.create_group('other'); o['fs'] = 50; o['acc'] = -x",
      "t = np.zeros(80, [('time', 'f8'), ('acc', 'f4'), ('name', 'S3')])\n"
      "t['time'], t['acc'] = np.arange(80) / 2000, x; f['table'] = t");
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.h5";
  const auto values = testing::python_numbers(
      "import h5py\nx = np.round(8 * np.sin(0.3 * "
      "np.arange(80))) / 8\nf = h5py.File('" +
      file + "', 'w')\n" + write + "\nf.close()\nout(x)\n");
  CAPTURE(write);
  ReadingOptions options;
  options.column = write.starts_with("f['data']") ? "data:2" : "";
  options.column = write.starts_with("f['fs']") ? "a/b/acc" : options.column;
  const Recording recording = read_recording(file, options);
  CHECK(recording.samples == values);
  CHECK(recording.rate_hz == Approx(rate_hz));
}

TEST_CASE("scalars in other structures than an array's give no rate where they differ",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.mat";
  saved_by_scipy({{file, "'acc': x, 'dac': {'fs': 48000.0}, 'adc': {'fs': 2000.0}"},
                  {directory / "one.mat", "'acc': x, 'adc': {'fs': 2000.0}"}});
  CHECK_THROWS_WITH(read_recording(file, {}), Contains("states no rate"));
  CHECK(read_recording(directory / "one.mat", {}).rate_hz == rate_hz);
}

TEST_CASE("an HDF5 file as Octave writes it is read by its variables' names",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.h5";
  testing::python_numbers("import h5py\nf = h5py.File('" + file +
                          "', 'w')\n"
                          "for name, kind, value in (('fs', 'scalar', 2000.0),\n"
                          "    ('acc', 'matrix', np.sin(0.3 * np.arange(80)).reshape(80, 1))):\n"
                          "  g = f.create_group(name)\n"
                          "  g.attrs['OCTAVE_NEW_FORMAT'] = np.uint8(1)\n"
                          "  g['type'], g['value'] = np.bytes_(kind), value\n"
                          "f.close()\nout([0])\n");
  const Recording recording = read_recording(file, {});
  CHECK(recording.channel == "acc");
  CHECK(recording.rate_hz == rate_hz);
  CHECK(recording.samples.at(1) == Approx(std::sin(0.3)));
}

TEST_CASE("what a library takes for sound without a header is no recording",
          "[analysis][recordings][formats]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.wav";  // a MATLAB file under another name
  testing::python_numbers("from scipy.io import savemat\nsavemat('" + file +
                          "', {'fs': 8000.0, 'acc': np.sin(0.3 * np.arange(800))}, "
                          "appendmat=False)\nout([1.0])\n");
  CHECK_THROWS_WITH(read_recording(file, {}), Contains("is no sound file"));
  for (const std::string name : {"taps.tdms", "taps.npy"}) {
    CHECK_THROWS_WITH(read_recording(directory / name, {}), Contains("save"));
  }
}
