#include "core/text/spreadsheet_cell.hpp"

#include <string>
#include <vector>

#include "core/text/plain_text.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

TEST_CASE("every text is read back from its cell as it was, and no cell begins as a formula",
          "[core][output]") {
  const std::vector<std::string> parts{"'", "=", "-", "@", "\t", "1", "x", "\xEF\xBC\x9D"};
  std::vector<std::string> texts{""};
  for (std::size_t begin = 0, length = 0; length < 4; ++length) {  // all of up to four parts
    const std::size_t end = texts.size();
    for (; begin < end; ++begin) {
      for (const std::string& part : parts) {
        texts.push_back(texts[begin] + part);
      }
    }
  }
  for (const std::string& text : texts) {
    const std::string cell = core::guarded_cell(text);
    if (core::text_of_cell(cell) != text) {
      FAIL("'" << text << "' is read back from '" << cell << "' as '" << core::text_of_cell(cell)
               << "'");
    }
    const bool begins_as_formula =
        cell.find_first_of("=-@\t") == 0 || cell.starts_with(parts.back());
    if (begins_as_formula && !core::number_in<double>(cell)) {
      FAIL("a spreadsheet would run '" << cell << "'");
    }
  }
  CHECK(texts.size() == 4681);
}

TEST_CASE("a number is no formula", "[core][output]") {
  for (const char* const number : {"-3", "+2", "-0.5e-3", "12", "-1E9"}) {
    CHECK(core::guarded_cell(number) == number);
  }
  CHECK(core::guarded_cell("-1+2") == "'-1+2");
  CHECK(core::guarded_cell("- none") == "'- none");
  CHECK(core::guarded_cell("\r=1") == "'\r=1");
  CHECK(core::guarded_cell("a=1") == "a=1");
}
