#include "runner/studies/shares/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "results/store/merged_copy.hpp"
#include "results/store/store.hpp"
namespace tapstudy::runner {
namespace {
ShareDirectory share_of(const std::string& directory) {
  std::optional<ShareFile> share = share_in(directory);
  if (!share) {
    throw core::InvalidInput{directory +
                             ": is no complete share of a simulation (of `simulate --share` or "
                             "`check --share`; one that was killed is to be run again)"};
  }
  return {directory, std::move(*share)};
}

void check_are_of_one(const ShareDirectory& first, const ShareDirectory& other) {
  const std::string difference = difference_between(first.file.of, other.file.of);
  if (!difference.empty()) {
    throw core::InvalidInput{fmt::format("{} and {} are shares of different simulations: {}",
                                         first.directory, other.directory, difference)};
  }
}

// Sorted shares.
void check_each_is_there_once(const std::vector<ShareDirectory>& shares) {
  for (std::size_t i = 1; i < shares.size(); ++i) {
    if (shares[i].file.of.share == shares[i - 1].file.of.share) {
      throw core::InvalidInput{fmt::format("{} and {} both hold share {}", shares[i - 1].directory,
                                           shares[i].directory, to_text(shares[i].file.of.share))};
    }
  }
  const int of = shares.front().file.of.share.of;
  for (int number = 1; number <= of; ++number) {
    if (std::ranges::find(shares, number, [](const ShareDirectory& share) {
          return share.file.of.share.number;
        }) == shares.end()) {
      throw core::InvalidInput{
          fmt::format("share {} is not among these directories", to_text(Share{number, of}))};
    }
  }
}

// A store that was put into another share's place would count its participants twice.
void check_participants(const ShareDirectory& share) {
  const SharedSimulation& of = share.file.of;
  results::Store store = results::Store::open_existing(share.directory);
  const SharedOut part = part_of(of.share, of.participants, "participants");
  std::set<int> expected;
  for (int i = part.first; i < part.end; ++i) {
    expected.insert(i);
  }
  std::set<int> found;
  for (const results::SessionRow& session : store.sessions()) {
    const auto index = static_cast<std::uint64_t>(session.participant_index);
    const bool is_its =
        session.mode == results::Mode::simulated &&
        session.seed == core::derived_seed(of.seed, core::Purpose::participant, index);
    found.insert(is_its ? session.participant_index : -1);
  }
  if (found != expected) {
    throw core::InvalidInput{fmt::format("{}: study.db does not hold the participants of share {}",
                                         share.directory, to_text(of.share))};
  }
}
}  // namespace

std::vector<ShareDirectory> whole_of(const std::vector<std::string>& directories) {
  std::vector<ShareDirectory> shares;
  for (const std::string& directory : directories) {
    shares.push_back(share_of(directory));
    check_are_of_one(shares.front(), shares.back());
  }
  std::ranges::sort(shares, {},
                    [](const ShareDirectory& share) { return share.file.of.share.number; });
  check_each_is_there_once(shares);
  if (shares.front().file.of.studies == 0) {
    std::ranges::for_each(shares, check_participants);
  }
  return shares;
}

bool are_shares(const std::vector<std::string>& directories) {
  return std::ranges::all_of(
      directories, [](const std::string& directory) { return share_in(directory).has_value(); });
}

void write_whole(const std::vector<ShareDirectory>& shares, const std::string& directory) {
  std::vector<std::string> directories;
  for (const ShareDirectory& share : shares) {
    directories.push_back(share.directory);
  }
  results::write_merged_copy(directories, directory);
}

std::vector<ResultsOfStudy> results_of(const std::vector<ShareDirectory>& shares) {
  std::vector<ResultsOfStudy> all;
  for (const ShareDirectory& share : shares) {
    all.insert(all.end(), share.file.results.begin(), share.file.results.end());
  }
  return all;
}
}  // namespace tapstudy::runner
