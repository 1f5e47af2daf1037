#include "core/tick/modal_state.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <tuple>
namespace tapstudy::core {
void flush(Eigen::ArrayXd& values) noexcept {
  constexpr double silence = 1e-100;
  for (double& value : values) {
    value = std::abs(value) < silence ? 0.0 : value;
  }
}

void modes_along(const ModalModel& model, const SurfacePoint& point, const Vec3& normal,
                 Eigen::ArrayXd& along) noexcept {
  struct Part {
    double weight;
    const double* shape;  // of all modes
  };
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): the first `count` are set
  std::array<Part, 3 * std::tuple_size_v<decltype(point.nodes)>> parts;
  std::size_t count = 0;
  for (std::size_t i = 0; i < point.count; ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double weight = point.weights[i] * normal[axis];
      if (weight != 0.0) {
        const Eigen::Index row = Eigen::Index{3} * point.nodes[i] + axis;
        parts[count++] = {weight, model.shape.data() + row * model.shape.outerStride()};
      }
    }
  }
  // Sums of a few modes stay in registers while the parts are added to them.
  constexpr Eigen::Index block = 8;
  using Block = Eigen::Array<double, block, 1>;
  Eigen::Index first = 0;
  for (; first + block <= along.size(); first += block) {
    Block sum = Block::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      sum += parts[i].weight * Eigen::Map<const Block>{parts[i].shape + first};
    }
    along.segment<block>(first) = sum;
  }
  for (; first < along.size(); ++first) {
    along[first] = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      along[first] += parts[i].weight * parts[i].shape[first];
    }
  }
}

ModalState::ModalState(const ModalModel& model, Integrator integrator, double dt_s)
    : model_{&model} {
  const Eigen::Index modes = model.frequency_hz.size();
  for (Eigen::ArrayXd* array : {&qq_, &qv_, &vq_, &vv_, &held_q_, &held_v_, &displacement_,
                                &velocity_, &previous_, &touched_}) {
    array->setZero(modes);
  }
  for (Eigen::Index i = 0; i < modes; ++i) {
    const double omega = 2.0 * std::numbers::pi * model.frequency_hz[i];
    const StateTransition step = state_transition(integrator, omega, model.damping_ratio[i], dt_s);
    const HeldForceResponse held =
        held_force_response(integrator, omega, model.damping_ratio[i], dt_s);
    qq_[i] = step.qq;
    qv_[i] = step.qv;
    vq_[i] = step.vq;
    vv_[i] = step.vv;
    held_q_[i] = held.q;
    held_v_[i] = held.v;
  }
}

void ModalState::touch(const SurfacePoint& point, const Vec3& normal) noexcept {
  modes_along(*model_, point, normal, touched_);
}

void ModalState::strike(double impulse_n_s) noexcept {
  velocity_ += impulse_n_s * touched_;
}

// eq. 11, all modes at once; as array expressions they are vectorised.
void ModalState::tick() noexcept {
  previous_.swap(displacement_);
  displacement_ = qq_ * previous_ + qv_ * velocity_;
  velocity_ = vq_ * previous_ + vv_ * velocity_;
  if (++since_flush_ == ticks_to_flush) {
    flush(displacement_);
    flush(velocity_);
    since_flush_ = 0;
  }
}

void ModalState::push(double force_n) noexcept {
  displacement_ += force_n * held_q_ * touched_;
  velocity_ += force_n * held_v_ * touched_;
}

void ModalState::reset() noexcept {
  displacement_.setZero();
  velocity_.setZero();
  previous_.setZero();
  since_flush_ = 0;
}

// eq. 9 at the touched point: the nodes' displacements, weighted by eq. 16, along the normal.
double ModalState::displacement_m() const noexcept {
  return (touched_ * displacement_).sum();
}

double ModalState::velocity_m_s() const noexcept {
  return (touched_ * velocity_).sum();
}

double ModalState::previous_displacement_m() const noexcept {
  return (touched_ * previous_).sum();
}

double ModalState::compliance_m_per_n() const noexcept {
  return (touched_.square() * held_q_).sum();
}

double ModalState::energy_j() const noexcept {
  const double turn = 2.0 * std::numbers::pi;
  return 0.5 * (velocity_.square() + (turn * model_->frequency_hz * displacement_).square()).sum();
}
}  // namespace tapstudy::core
