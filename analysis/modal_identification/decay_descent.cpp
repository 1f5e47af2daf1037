#include "analysis/modal_identification/decay_descent.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>
namespace tapstudy::analysis {
namespace {
constexpr int max_steps = 60;

// One decay's normal equations, in blocks: shared poles as s [1/s], own poles and shares in columns
// of unit length.
struct Normal {
  Eigen::MatrixXd shared;
  Eigen::MatrixXd between;  // shared × own
  Eigen::MatrixXd own;
  Eigen::VectorXd shared_slope;
  Eigen::VectorXd own_slope;
  Eigen::VectorXd own_size;
};

double seconds(const DecayModel& model) {
  return model.length() / model.rate_hz();
}

Normal normal_equations(const WeightedDecay& decay, Eigen::Index shared) {
  const Eigen::MatrixXd jacobian = decay.model.jacobian(decay.state);
  const Eigen::MatrixXd of_shared = jacobian.leftCols(2 * shared) * seconds(decay.model);
  Eigen::MatrixXd of_own = jacobian.rightCols(jacobian.cols() - 2 * shared);
  const Eigen::VectorXd size = of_own.colwise().norm().cwiseMax(1e-300).transpose();
  of_own = of_own * size.cwiseInverse().asDiagonal();
  const double weight = decay.weight;
  return {weight * of_shared.transpose() * of_shared,
          weight * of_shared.transpose() * of_own,
          weight * of_own.transpose() * of_own,
          weight * of_shared.transpose() * decay.state.residual,
          weight * of_own.transpose() * decay.state.residual,
          size};
}

void damp(Eigen::MatrixXd& matrix, double damping) {
  matrix.diagonal() *= 1.0 + damping;
}

// The steps of the shared poles [1/s] and, decay by decay, of their own ones.
struct Step {
  Eigen::VectorXd shared;
  std::vector<Eigen::VectorXd> own;
};
Step step_of(const std::vector<Normal>& normals, double damping) {
  const Eigen::Index shared = normals.front().shared_slope.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(shared, shared);
  for (const Normal& normal : normals) {
    matrix += normal.shared;
  }
  damp(matrix, damping);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(shared);
  std::vector<Eigen::LDLT<Eigen::MatrixXd>> own;
  for (const Normal& normal : normals) {
    Eigen::MatrixXd damped = normal.own;
    damp(damped, damping);
    own.emplace_back(damped);
    matrix -= normal.between * own.back().solve(normal.between.transpose());
    slope += normal.shared_slope - normal.between * own.back().solve(normal.own_slope);
  }
  Step step{Eigen::LDLT<Eigen::MatrixXd>{matrix}.solve(slope), {}};
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Normal& normal = normals[i];
    step.own.emplace_back(own[i]
                              .solve(normal.own_slope - normal.between.transpose() * step.shared)
                              .cwiseQuotient(normal.own_size));
  }
  return step;
}

double sum_of_squares(const std::vector<WeightedDecay>& decays) {
  double sum = 0.0;
  for (const WeightedDecay& decay : decays) {
    sum += decay.weight * decay.state.sum_of_squares;
  }
  return sum;
}

std::vector<Normal> normal_equations(const std::vector<WeightedDecay>& decays,
                                     Eigen::Index shared) {
  std::vector<Normal> normals;
  for (const WeightedDecay& decay : decays) {
    normals.push_back(normal_equations(decay, shared));
  }
  return normals;
}

std::vector<DecayModel::State> moved(const std::vector<WeightedDecay>& decays, const Step& step) {
  std::vector<DecayModel::State> states;
  for (std::size_t i = 0; i < decays.size(); ++i) {
    const DecayModel& model = decays[i].model;
    Eigen::VectorXd logs = decays[i].state.logs;
    const Eigen::Index own = logs.size() - step.shared.size();
    logs.head(step.shared.size()) += step.shared * seconds(model);
    logs.tail(own) += step.own[i].head(own);
    states.push_back(model.at(logs));
  }
  return states;
}

void exchange(std::vector<WeightedDecay>& decays, std::vector<DecayModel::State>& states) {
  for (std::size_t i = 0; i < decays.size(); ++i) {
    std::swap(decays[i].state, states[i]);
  }
}
}  // namespace

bool descend(std::vector<WeightedDecay>& decays, Eigen::Index shared) {
  double damping = 1e-3;
  double before = sum_of_squares(decays);
  std::vector<Normal> normals = normal_equations(decays, shared);
  for (int step = 0; step < max_steps; ++step) {
    std::vector<DecayModel::State> states = moved(decays, step_of(normals, damping));
    exchange(decays, states);
    const double after = sum_of_squares(decays);
    if (!(after <= before)) {
      exchange(decays, states);
      damping *= 8.0;
      if (damping > 1e8) {
        return true;  // no direction leads down
      }
      continue;
    }
    if (before - after <= 1e-7 * before) {
      return true;
    }
    before = after;
    damping = std::max(damping / 5.0, 1e-12);
    normals = normal_equations(decays, shared);
  }
  return false;
}

Eigen::MatrixXd information_on_shared(const std::vector<WeightedDecay>& decays,
                                      Eigen::Index shared) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * shared, 2 * shared);
  for (const Normal& normal : normal_equations(decays, shared)) {
    matrix += normal.shared - normal.between * Eigen::LDLT<Eigen::MatrixXd>{normal.own}.solve(
                                                   normal.between.transpose());
  }
  return matrix;
}
}  // namespace tapstudy::analysis
