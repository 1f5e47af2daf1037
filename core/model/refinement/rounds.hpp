#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/model/fixation.hpp"
#include "core/model/modal_model.hpp"
namespace tapstudy::core {
// What both ways to refine a mesh share.
inline constexpr double tets_of_first_round = 200.0;
inline constexpr std::size_t max_rounds = 8;

void add(const ModelCost& more, ModelCost& to);

// Of the frequencies that both have, as a share.
double largest_change(const Eigen::ArrayXd& before, const Eigen::ArrayXd& after);

// Throws ModelError, naming the key, if one of them is a point or a line.
void check_can_settle(const std::vector<Fixation>& fixations, const char* key);

// The area held by each fixation must settle as well: a region that keeps catching nodes stiffens
// the body while its elements soften. Empty where it has, else which has not, and why.
std::string nonconverged_region(const std::vector<double>& before_m2,
                                const std::vector<double>& after_m2);
}  // namespace tapstudy::core
