#include "core/tick/modal_state.hpp"

#include <numbers>
namespace tapstudy::core {
namespace {
// A decaying state is flushed to zero before it becomes denormal, where arithmetic is slow. The
// smallest relevant motion is some eighty orders of magnitude larger.
constexpr double silence = 1e-100;

void flush_to_zero(Eigen::ArrayXd& state) noexcept {
  state = (state.abs() < silence).select(0.0, state);
}
}  // namespace

ModalState::ModalState(const ModalModel& model, Integrator integrator, double dt_s)
    : model_{&model} {
  const Eigen::Index modes = model.frequency_hz.size();
  for (Eigen::ArrayXd* array :
       {&qq_, &qv_, &vq_, &vv_, &displacement_, &velocity_, &next_, &touched_}) {
    array->setZero(modes);
  }
  for (Eigen::Index i = 0; i < modes; ++i) {
    const double omega = 2.0 * std::numbers::pi * model.frequency_hz[i];
    const StateTransition step = state_transition(integrator, omega, model.damping_ratio[i], dt_s);
    qq_[i] = step.qq;
    qv_[i] = step.qv;
    vq_[i] = step.vq;
    vv_[i] = step.vv;
  }
}

void ModalState::touch(const SurfacePoint& point, const Vec3& normal) noexcept {
  touched_.setZero();
  for (std::size_t i = 0; i < point.count; ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double weight = point.weights[i] * normal[axis];
      if (weight != 0.0) {
        touched_ +=
            weight * model_->shape.row(Eigen::Index{3} * point.nodes[i] + axis).transpose().array();
      }
    }
  }
}

void ModalState::strike(double impulse_n_s) noexcept {
  velocity_ += impulse_n_s * touched_;
}

void ModalState::tick() noexcept {
  // eq. 11, all modes at once
  next_ = qq_ * displacement_ + qv_ * velocity_;
  velocity_ = vq_ * displacement_ + vv_ * velocity_;
  displacement_.swap(next_);
  flush_to_zero(displacement_);
  flush_to_zero(velocity_);
}

void ModalState::reset() noexcept {
  displacement_.setZero();
  velocity_.setZero();
}

// eq. 9 at the touched point: the nodes' displacements, weighted by eq. 16, along the normal.
double ModalState::displacement_m() const noexcept {
  return (touched_ * displacement_).sum();
}

double ModalState::velocity_m_s() const noexcept {
  return (touched_ * velocity_).sum();
}

double ModalState::energy_j() const noexcept {
  const double turn = 2.0 * std::numbers::pi;
  return 0.5 * (velocity_.square() + (turn * model_->frequency_hz * displacement_).square()).sum();
}
}  // namespace tapstudy::core
