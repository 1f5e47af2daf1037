#pragma once
#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
// A stimulus as it is presented: itself, or the member of its family at these values. Holds all
// that a renderer needs, so that nothing else asks what varies.
struct PresentedStimulus {
  std::string name;                    // of the stimulus
  std::shared_ptr<const Plate> plate;  // as presented
  std::shared_ptr<const Material> material;
  const core::Technique* technique{};
  core::RenderSettings rendering;              // the protocol's, for this plate and these values
  AxisValues values;                           // of every axis of its `vary`; empty without one
  AxisValues changed;                          // those that differ from the stimulus's own
  std::shared_ptr<const Plate> own_plate;      // the stimulus's, whatever the values
  std::shared_ptr<const Contacts> contacts{};  // nullptr: it touches no other body
  std::string vary_stated_at{};                // where the protocol says what may change

  // "stimulus 'a' at youngs_modulus_pa = 1e+09", for messages.
  std::string title() const;
};

// The member at exactly these values; axes without a value have the stimulus's own. The values must
// be those of presented_values, or the stimulus's own.
PresentedStimulus stimulus_with(const Protocol& protocol, const Stimulus& stimulus,
                                const AxisValues& values = {});

// What is presented if these values are asked for: every axis of the stimulus's `vary`, with the
// nearest value of the table on a tabled axis (never interpolated), and the stimulus's own value
// where none was asked for. Throws InvalidInput for names that are no axes, axes along which this
// stimulus does not vary or which its technique does not use, values out of range, and NaN.
AxisValues presented_values(const Protocol& protocol, const Stimulus& stimulus,
                            const AxisValues& asked);

// The member nearest to what is asked: stimulus_with(presented_values(asked)). Throws as that does.
PresentedStimulus stimulus_at(const Protocol& protocol, const Stimulus& stimulus,
                              const AxisValues& asked);

// The values of the tabled axes for which a body is solved before a session: each combination of
// listed values and the stimulus's own. One without values if no axis is tabled.
std::vector<AxisValues> table_of_models(const Protocol& protocol, const Stimulus& stimulus);

// More bodies of one stimulus are refused.
inline constexpr std::size_t max_models_of_a_stimulus = 200;
}  // namespace tapstudy::protocols
