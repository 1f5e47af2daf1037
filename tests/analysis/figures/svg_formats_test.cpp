// Figures as PDF, read by poppler's tools.
#include "analysis/figures/svg_formats.hpp"

#include <fmt/format.h>

#include "analysis/tables/chart.hpp"
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
