// A study as a dataset of the Brain Imaging Data Structure.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "results/export/bids_labels.hpp"
#include "support/catch.hpp"
#include "support/messy_study.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
using testing::TempDirectory;
namespace fs = std::filesystem;
namespace messy = testing::messy_study;

namespace {
std::string dataset_of(const TempDirectory& directory, const std::string& study) {
  const std::string dataset = directory / "dataset";
  const auto run = testing::tapstudy({"export", study, "--format", "bids", "--out", dataset});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  return dataset;
}
}  // namespace

TEST_CASE("the public validator of BIDS finds no error in an export", "[results][export]") {
  const TempDirectory directory;
  const std::string dataset = dataset_of(directory, messy::make(directory));
  const char* const validator = std::getenv("BIDS_VALIDATOR");
  if (validator == nullptr) {
    WARN("NOT TESTED: BIDS_VALIDATOR names no program (npm install bids-validator@1)");
    return;
  }
  const auto run = testing::run_program({validator, dataset, "--json"});
  INFO(run.standard_output << run.standard_error);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.standard_output, Contains("\"errors\":[]"));
  fs::remove(dataset + "/dataset_description.json");  // what it says of a broken one
  CHECK(testing::run_program({validator, dataset, "--json"}).exit_code != 0);
}

TEST_CASE("pandas reads of a BIDS dataset what is in the store", "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const auto read = testing::run_program({"/usr/bin/python3",
                                          testing::source("tests/results/export/bids_reader.py"),
                                          study, dataset_of(directory, study)});
  INFO(read.standard_error);
  CHECK(read.exit_code == 0);
  CHECK_THAT(read.standard_output, Contains("recordings"));
  CHECK_THAT(read.standard_output, !Contains(" 0 answers") && !Contains(" 0 events"));
}

TEST_CASE("names of people and what they wrote stay out of a BIDS dataset", "[results][export]") {
  const TempDirectory directory;
  const std::string dataset = dataset_of(directory, messy::make(directory));
  CHECK(fs::is_directory(dataset + "/sub-p01"));
  for (const std::string& removed :
       {std::string{"Anna"}, std::string{"early"}, std::string{"say \"hi\""}}) {
    const auto found = testing::run_program({"/bin/grep", "-rlF", removed, dataset});
    CHECK(found.standard_output.empty());
  }
}

TEST_CASE("labels are letters and digits, and never the same twice", "[results][export]") {
  const BidsLabels labels = bids_labels({"P-01", "P01", "p_01", "Anna M.", "\xC3\xA4", "--"}, "x");
  CHECK(labels.by_name.at("P-01") == "P01");
  CHECK(labels.by_name.at("P01") == "P01x2");
  CHECK(labels.by_name.at("p_01") == "p01x3");
  CHECK(labels.by_name.at("Anna M.") == "x01");
  CHECK(labels.by_name.at("\xC3\xA4") == "x02");
  CHECK(labels.by_name.at("--") == "x03");
  REQUIRE(labels.notes.size() == 2);
  CHECK(bids_labels({"a", "b"}, "x").notes.empty());
}

TEST_CASE("a BIDS dataset says all that a trial presented, with what varied", "[results][export]") {
  const TempDirectory directory;
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("examples/stiffness_jnd.yaml").string(),
                             "--participants", "1", "--no-traces", "--out", directory / "study"})
              .exit_code == 0);
  const std::string dataset = dataset_of(directory, directory / "study");
  const std::string trials =
      testing::contents(dataset + "/sub-sim01/beh/sub-sim01_task-stiffness_beh.tsv");
  CHECK_THAT(trials, Contains("plate (youngs_modulus_pa=3.2e+09); plate* (youngs_modulus_pa=") &&
                         Contains("plate* (youngs_modulus_pa=") &&
                         Contains("; plate (youngs_modulus_pa=3.2e+09)"));
}
