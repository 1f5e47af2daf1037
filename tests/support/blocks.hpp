#pragma once
#include <string>
#include <vector>

#include "protocols/reader/read_protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "support/texts.hpp"
// Studies of the paper's plates with blocks of these names.
namespace tapstudy::testing {
using Names = std::vector<std::string>;

// Blocks whose names begin with "practice" are practice. `keys` follows the blocks.
inline std::string text_with_blocks(const Names& blocks, const std::string& keys) {
  const std::string whole = contents(shipped("paper/discrimination.yaml"));
  std::string text = whole.substr(0, whole.find("\nblocks:")) + "\nblocks:\n";
  for (const std::string& name : blocks) {
    text += "  - {name: " + name + ", task: identification, question: \"Which?\", " +
            "stimuli: [mdf_two, mdf_three, acrylic_two], order: williams, " +
            "explore: {min_contacts: 0}" +
            (name.starts_with("practice") ? ", practice: true}\n" : "}\n");
  }
  return text + keys;
}

// The first alternative of each of a block's trials, in their order.
inline Names stimuli_of(const std::string& block, const protocols::Schedule& schedule) {
  Names names;
  for (const protocols::PlannedTrial& trial : schedule) {
    if (trial.block == block) {
      names.push_back(trial.alternatives.front().stimulus);
    }
  }
  return names;
}

inline protocols::Protocol with_blocks(const Names& blocks, const std::string& keys) {
  return protocols::parse_protocol(text_with_blocks(blocks, keys), "study.yaml");
}
}  // namespace tapstudy::testing
