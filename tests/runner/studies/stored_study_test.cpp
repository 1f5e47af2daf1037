#include "runner/studies/stored_study.hpp"

#include "core/error.hpp"
#include "core/files/sha256.hpp"
#include "runner/studies/study_summary.hpp"
#include "support/catch.hpp"
#include "support/study_files.hpp"
using namespace tapstudy;

namespace {
std::string text_without_order() {
  return testing::replaced(testing::varied_study_text, "    mesh: {order: 1}\n", "");
}

// A study of this text, with a session run by a version of the program.
void write_study(const std::string& directory, const std::string& text,
                 const std::string& version) {
  const results::StudyRow study{"a study", "study.yaml", text, core::sha256(text), {}};
  results::Store store = results::Store::open_or_create(directory, study);
  results::SessionRow session;
  session.participant_id = "P-" + version;
  session.participant_index = static_cast<int>(store.sessions().size());
  session.rate_hz = 1000.0;
  session.program_version = version;
  session.started_utc = "when " + version + " ran it";
  store.add_session(session);
}
int stored_order(const std::string& directory) {
  results::Store store = results::Store::open_existing(directory);
  return runner::stored_protocol(store).plates.at("screwed")->mesh.order;
}
}  // namespace

TEST_CASE("a study that was begun with linear elements keeps them, and a later one has its own",
          "[runner][model]") {
  const testing::TempDirectory directory;
  testing::write(directory / "study.yaml", text_without_order());
  const auto order_to_go_on_with = [&](const std::string& study) {
    return runner::protocol_to_go_on_with(directory / "study.yaml", {}, directory / study)
        .plates.at("screwed")
        ->mesh.order;
  };
  CHECK(order_to_go_on_with("none") == core::chosen_order);
  for (const char* const version : {"0.1.0", "0.2.0"}) {
    write_study(directory / version, text_without_order(), version);
    CHECK(stored_order(directory / version) == 1);
    CHECK(order_to_go_on_with(version) == 1);
  }
  write_study(directory / "0.1.0", text_without_order(), "0.3.0");  // another participant, today
  CHECK(stored_order(directory / "0.1.0") == 1);
  for (const char* const version : {"0.3.0", "0.10.0", "1.0.0"}) {
    write_study(directory / version, text_without_order(), version);
    CHECK(stored_order(directory / version) == core::chosen_order);
    CHECK(order_to_go_on_with(version) == core::chosen_order);
  }
}

TEST_CASE("answers about linear and quadratic elements are not put into one report",
          "[runner][report]") {
  const testing::TempDirectory directory;
  const auto said_of = [&](const std::string& name, const std::string& text) {
    write_study(directory / (name + "/a"), text, "0.2.0");
    write_study(directory / (name + "/b"), text, "0.3.0");
    results::Store a = results::Store::open_existing(directory / (name + "/a"));
    results::Store b = results::Store::open_existing(directory / (name + "/b"));
    try {
      runner::summary_of_study({{"a", &a}, {"b", &b}}, results::Mode::real,
                               runner::Detail::main_results);
    } catch (const core::InvalidInput& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };
  CHECK_THAT(said_of("unstated", text_without_order()),
             Contains("a, b: the plate of 'a' states no mesh.order"));
  CHECK_THAT(said_of("stated", testing::varied_study_text), Contains("no answers"));
}
