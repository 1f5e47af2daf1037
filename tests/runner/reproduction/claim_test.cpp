// Judgements follow from numbers by the stated rule, and every format says the same.
#include "runner/reproduction/claim.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/tables/cells.hpp"
#include "runner/reproduction/writers.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::runner;

namespace {
Method method_that(bool confirms) {
  return {confirms ? "good" : "bad", "tapstudy modes x", {at_most(confirms ? 2.0 : 0.0, "m", 1.0)}};
}

Reproduction made_up() {
  Claim odd{.name = "odd", .section = "section <9>", .statement = "a < b & \"c\"", .rule = "r"};
  odd.methods = {{"first",
                  "tapstudy tap a&b",
                  {at_least(1.5, "one & only", 1.25, "mm"), shown("seen", 1e-7, "µm"),
                   at_most(3.0, "none", std::nan(""))}},
                 {"second", "tapstudy modes", {at_most(3.0, "small", 2.0, "%")}}};
  odd.findings = {shown("found", 12345.678, "Hz")};
  odd.remarks = {"a remark"};
  Reproduction reproduction;
  reproduction.seed = std::numeric_limits<std::uint64_t>::max();
  reproduction.groups = {{"A group", {odd}}};
  reproduction.not_reproducible = {{"section 1", "what", "why & how"}};
  return reproduction;
}

template <class Write>
std::string written(const Write& write, const Reproduction& reproduction) {
  std::ostringstream out;
  write(out, reproduction);
  return out.str();
}
bool says(const std::string& page, const std::string& words) {
  return page.find(analysis::escaped(words)) != std::string::npos;
}
}  // namespace

TEST_CASE("a claim is true if every method confirms it, false if none does, else it depends",
          "[runner][reproduction]") {
  for (unsigned int which = 0; which < 8; ++which) {
    Claim claim;
    for (unsigned int i = 0; i < 3; ++i) {
      claim.methods.push_back(method_that((which >> i & 1U) != 0));
    }
    CHECK(name(claim.verdict()) == (which == 7 ? "true" : which == 0 ? "false" : "depends"));
  }
}

TEST_CASE("a measure holds up to its limit; what is no number keeps none",
          "[runner][reproduction]") {
  const double limit = 0.1;
  const double beyond = std::nextafter(limit, 1.0);
  CHECK(at_most(limit, "m", limit).holds());
  CHECK_FALSE(at_most(limit, "m", beyond).holds());
  CHECK(at_least(limit, "m", limit).holds());
  CHECK_FALSE(at_least(beyond, "m", limit).holds());
  CHECK_FALSE(at_most(limit, "m", std::nan("")).holds());
  CHECK_FALSE(at_least(limit, "m", std::nan("")).holds());
  CHECK(within(limit, beyond, "m", limit).holds());
  CHECK(within(limit, beyond, "m", beyond).holds());
  CHECK_FALSE(within(limit, beyond, "m", 0.0).holds());
  CHECK_FALSE(within(limit, beyond, "m", 0.2).holds());
  CHECK_FALSE(within(limit, beyond, "m", std::nan("")).holds());
  CHECK(shown("m", std::nan("")).holds());
}

TEST_CASE("one measure that does not hold refutes its method, and is named",
          "[runner][reproduction]") {
  Claim claim;
  claim.methods = {{"way", "", {at_most(1.0, "fits", 0.5), at_most(1.0, "too much", 2.0, "mm")}}};
  CHECK_FALSE(claim.methods.front().confirms());
  REQUIRE(claim.reasons().size() == 1);
  CHECK(claim.reasons().front() == "Does not hold way: too much is 2 mm, not at most 1 mm.");
}

TEST_CASE("the page and JSON say the same", "[runner][reproduction]") {
  const Reproduction reproduction = made_up();
  const std::string page = written(write_html, reproduction);
  const auto json = nlohmann::json::parse(written(write_json, reproduction));
  REQUIRE(json["claims"].size() == 1);
  const auto& claim = json["claims"][0];
  CHECK(claim["verdict"] == "depends");
  CHECK(page.find("<span class=\"verdict depends\">depends</span>") != std::string::npos);
  CHECK(page.find("id=\"" + claim["name"].get<std::string>() + '"') != std::string::npos);
  for (const char* const key : {"section", "statement", "rule"}) {
    INFO(key);
    CHECK(says(page, claim[key]));
  }
  CHECK(claim["reasons"].size() == 2);
  for (const auto& reason : claim["reasons"]) {
    CHECK(says(page, reason));
  }
  CHECK(says(page, claim["remarks"][0]));
  CHECK(says(page, json["command"]));
  CHECK(says(page, json["not_reproducible"][0]["why"]));
  for (const auto& method : claim["methods"]) {
    CHECK(says(page, method["command"]));
    for (const auto& measure : method["measures"]) {
      const double value =
          measure["value"].is_null() ? std::nan("") : measure["value"].get<double>();
      const std::string unit = measure["unit"];
      CHECK(page.find(analysis::escaped(measure["name"]) + "</th><td>" + analysis::rounded(value) +
                      (unit.empty() ? "" : " " + unit) + "</td>") != std::string::npos);
    }
  }
  CHECK(json["seed"].get<std::uint64_t>() == reproduction.seed);
  CHECK(claim["findings"][0]["value"] == 12345.678);
  CHECK(claim["methods"][0]["measures"][2]["holds"] == false);
  CHECK(claim["methods"][0]["measures"][1]["at_least"].is_null());
}

TEST_CASE("the page needs nothing beside it", "[runner][reproduction]") {
  const std::string page = written(write_html, made_up());
  for (const char* const reference :
       {"http:", "https:", "src=", "@import", "url(", "<link", "<script"}) {
    INFO(reference);
    CHECK(page.find(reference) == std::string::npos);
  }
}
