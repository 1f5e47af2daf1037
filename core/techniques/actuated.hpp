#pragma once
#include <complex>

#include "core/model/modal_model.hpp"
#include "core/settings/actuator_settings.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/actuator_voice.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::core {
// The factor on a command of this frequency with which the actuator exerts the force that is asked
// for: the inverse of its response, at most max_boost in magnitude.
std::complex<double> inverse_at(double frequency_hz, const ActuatorResponse& response);

// The share of a model's vibration that one of the two renders. The force of a mode is quadratic in
// its shape, once where it is struck and once where it is felt (paper eq. 15, 16), so that a shape
// times the root of a share gives that share of the force. Modes without a share are left out.
enum class RenderedBy { device, actuator };
ModalModel share_of(const ModalModel& model, const Crossover& crossover, RenderedBy by);

// What the actuator renders of a stimulus: its shares of the modes, of the sinusoid and of a
// recording. settings.crossover must be set. actuated: the actuator's share of the plate's
// model, null if the technique needs none; must outlive the voice.
ActuatorVoice make_voice(const Technique& technique, const RenderSettings& settings,
                         const VibratingPlate* actuated, const ActuatorResponse& response,
                         double sample_s);
}  // namespace tapstudy::core
