#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "runner/reproduction/bench.hpp"
#include "runner/reproduction/claim.hpp"
namespace tapstudy::runner {
// Of Figure 3, beside the page.
inline constexpr std::string_view strike_animation_file = "figure_3.png";

// Claims that are measured together. To add some: a file with a function, declared here, and a row
// in claim_table.cpp.
struct ClaimGroup {
  std::string_view name;  // by which `reproduce --only` chooses it
  std::string_view title;
  std::vector<Claim> (*measure)(Bench& bench);
};
const std::vector<ClaimGroup>& claim_groups();
std::vector<std::string> claim_group_names();
// All without names. Throws InvalidInput for a name that is of no group.
std::vector<ClaimGroup> claim_groups_named(const std::vector<std::string>& names);

std::vector<Claim> plate_model(Bench& bench);       // Table 1
std::vector<Claim> mode_count(Bench& bench);        // section 5.1
std::vector<Claim> mode_shapes(Bench& bench);       // Figure 3
std::vector<Claim> feedback_forces(Bench& bench);   // Figures 4 and 5
std::vector<Claim> step_time(Bench& bench);         // section 5.1
std::vector<Claim> finger_mass(Bench& bench);       // sections 5 and 7
std::vector<Claim> finger_vibration(Bench& bench);  // section 5.2.3
std::vector<Claim> discrimination(Bench& bench);    // Table 2
std::vector<Claim> reality(Bench& bench);           // sections 5.2.2 and 5.2.3

// What no computation can show, and why.
const std::vector<NotReproducible>& not_reproducible();
}  // namespace tapstudy::runner
