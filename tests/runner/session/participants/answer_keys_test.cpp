// Letters of a study's own that answer.
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/console/page_json.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::replaced;
using testing::TempDirectory;

namespace {
std::string with_keys(const std::string& file, const std::string& keys) {
  return replaced(testing::contents(testing::shipped(file)),
                  "\n    question:", "\n    keys: " + keys + "\n    question:");
}
std::string refusal_of(const std::string& file, const std::string& keys) {
  try {
    protocols::parse_protocol(with_keys(file, keys), "study.yaml");
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
}  // namespace

TEST_CASE("a key is one letter, stands once, and presents no alternative",
          "[runner][answer_keys]") {
  const std::string plates = "paper/discrimination.yaml";  // four answers, nothing to switch
  CHECK(refusal_of(plates, "[f, j, a, b]") == "accepted");
  CHECK_THAT(refusal_of(plates, "[f, j, f, b]"),
             Contains("blocks[0].keys[2]: 'f' is listed twice"));
  CHECK_THAT(refusal_of(plates, "[f, j]"), Contains("blocks[0].keys: are 2, of 4 answers"));
  for (const char* const none : {"ff", "\"1\"", "\":\"", "\"=\"", "\"+\"", "\" \""}) {
    CHECK_THAT(refusal_of(plates, std::string{"[f, j, d, "} + none + "]"),
               Contains("blocks[0].keys[3]"));
  }
  CHECK_THAT(refusal_of("paper/reality_finger.yaml", "[a, j, k]"),
             Contains("blocks[0].keys: 'a' is taken: it presents alternative A"));
}

TEST_CASE("the letters answer at the terminal, and are shown there and on the page",
          "[runner][answer_keys]") {
  const TempDirectory directory;
  testing::write(directory / "study.yaml",
                 replaced(with_keys("paper/discrimination.yaml", "[f, j, d, k]"), "repetitions: 2",
                          "repetitions: 1"));
  const auto run = testing::tapstudy({"run", directory / "study.yaml", "--participant", "P01",
                                      "--out", directory / "out", "--seed", "5"},
                                     "f\nJ\nq\nd\n4\n");
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.standard_error, Contains("\n  f  ") && Contains("\n  k  ") &&
                                     Contains("please type one of the keys f, j, d, k"));
  CHECK(testing::run_program({"/usr/bin/sqlite3", directory / "out/study.db",
                              "SELECT group_concat(response) FROM response"})
            .standard_output == "acrylic_two,mdf_two,acrylic_three,mdf_three\n");
  const auto protocol = protocols::read_protocol((directory / "study.yaml"));
  const protocols::Answers answers = protocols::answers_of(protocol.blocks.front(), protocol);
  CHECK(runner::answers_json(answers).at("keys").dump() == R"(["f","j","d","k"])");
}
