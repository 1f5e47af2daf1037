// Figures as PDF, read by poppler's tools.
#include "analysis/report/figures/image_formats.hpp"

#include <fmt/format.h>

#include "analysis/report/document/chart.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

TEST_CASE("a figure's PDF is one page of its size that holds its words as text",
          "[analysis][figures]") {
  analysis::Chart chart{"Force at P1 & P2", "", "time, µs", "force, N", {0.0, 1.0}, {0.0, 2.0}};
  chart.line = {{0.0, 0.0}, {1.0, 2.0}};
  const std::string svg = analysis::standalone_svg(chart, "SIMULATED");
  const testing::TempDirectory directory;
  testing::write(directory / "figure.pdf", analysis::pdf_of_svg(svg));
  const auto info = testing::run_program({"/usr/bin/pdfinfo", directory / "figure.pdf"});
  CHECK(info.exit_code == 0);
  CHECK_THAT(info.standard_output, Contains("Pages:           1"));
  const auto size_of = [&](const std::string& key) {
    return 0.75 * std::stod(svg.substr(svg.find(key) + key.size()));
  };
  CHECK_THAT(info.standard_output,
             Contains(fmt::format("{:g} x {:g} pts", size_of("width=\""), size_of("height=\""))));
  const auto words = testing::run_program({"/usr/bin/pdftotext", directory / "figure.pdf", "-"});
  for (const char* const text : {"Force at P1 & P2", "time, µs", "force, N", "SIMULATED"}) {
    CHECK_THAT(words.standard_output, Contains(text));
  }
}

TEST_CASE("what is no figure is refused", "[analysis][figures]") {
  for (const char* const text : {"", "no figure", "<svg", "<html/>"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(analysis::pdf_of_svg(text), core::InvalidInput);
  }
}

namespace {
std::string square(const char* colour, int size = 8) {
  return analysis::png_of_svg(
      fmt::format("<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{0}'><rect "
                  "width='{0}' height='{0}' fill='{1}'/></svg>",
                  size, colour),
      size);
}
}  // namespace

TEST_CASE("an animation is its frames, in chunks that Python's zlib checks and unpacks",
          "[analysis][figures]") {
  const testing::TempDirectory directory;
  testing::write(
      directory / "a.png",
      analysis::animated_png({square("#ff0000"), square("#00ff00"), square("#0000ff")}, 250));
  const auto read = testing::run_program({"/usr/bin/python3", "-c", R"(
import struct, sys, zlib
data = open(sys.argv[1], "rb").read()
assert data[:8] == b"\x89PNG\r\n\x1a\n"
at, chunks = 8, []
while at < len(data):
    length, kind = struct.unpack(">I4s", data[at:at + 8])
    body = data[at + 8:at + 8 + length]
    assert struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] == zlib.crc32(kind + body)
    chunks.append((kind, body))
    at += 12 + length
kinds = [kind for kind, _ in chunks]
assert kinds == [b"IHDR", b"acTL", b"fcTL", b"IDAT", b"fcTL", b"fdAT", b"fcTL", b"fdAT", b"IEND"], kinds
assert struct.unpack(">II", chunks[1][1]) == (3, 0)
controls = [struct.unpack(">IIIIIHHBB", body) for kind, body in chunks if kind == b"fcTL"]
assert [c[0] for c in controls] == [0, 1, 3] and all(c[1:] == (8, 8, 0, 0, 250, 1000, 0, 0) for c in controls)
assert [struct.unpack(">I", chunks[i][1][:4])[0] for i in (5, 7)] == [2, 4]
for i, skip, colour in ((3, 0, (255, 0, 0)), (5, 4, (0, 255, 0)), (7, 4, (0, 0, 255))):
    pixels = zlib.decompress(chunks[i][1][skip:])
    assert len(pixels) == 8 * (1 + 3 * 8) and tuple(pixels[1:4]) == colour, (i, pixels[:8])
)",
                                          directory / "a.png"});
  INFO(read.standard_error);
  CHECK(read.exit_code == 0);
}

TEST_CASE("frames that do not fit together are no animation", "[analysis][figures]") {
  CHECK_THROWS_AS(analysis::animated_png({}, 100), core::InvalidInput);
  CHECK_THROWS_AS(analysis::animated_png({"no picture"}, 100), core::InvalidInput);
  CHECK_THROWS_AS(analysis::animated_png({square("red"), square("red", 9)}, 100),
                  core::InvalidInput);
}
