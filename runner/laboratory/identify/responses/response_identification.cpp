#include "runner/laboratory/identify/responses/response_identification.hpp"

#include <fmt/format.h>

#include "analysis/modal/response/response_files.hpp"
#include "protocols/reader/read_protocol.hpp"
namespace tapstudy::runner {
namespace {
analysis::RepeatedMode repeated(const analysis::ResponseMode& mode, std::size_t responses) {
  analysis::RepeatedMode one;
  one.frequency_hz = mode.frequency_hz;
  one.damping_ratio = mode.damping_ratio;
  one.degrees_of_freedom = mode.degrees_of_freedom;
  one.standing = mode.standing;
  one.why = mode.why;
  one.amplitude = mode.share;
  one.taps = static_cast<int>(responses);
  one.agreed = one.taps;
  return one;
}

void compare(const protocols::Protocol& protocol, const core::ProgressHook& hook,
             ResponseIdentification& found) {
  MeasuredModes measured;
  for (const std::size_t i : found.agreed) {
    measured.frequencies_hz.push_back(found.modes[i].frequency_hz);
  }
  const Eigen::ArrayXd& hz = found.responses.measured.frequency_hz;
  found.model = compare_with_model(protocol, found.stimulus, measured, hz[hz.size() - 1], hook);
  for (const std::string& remark : remarks_on_springs(*found.model)) {
    found.remarks.push_back(remark);
  }
}
}  // namespace

ResponseIdentification identify_responses(const ResponseQuestion& question, Progress& progress) {
  std::optional<protocols::Protocol> protocol;
  if (!question.protocol.empty()) {
    protocol = protocols::read_protocol(question.protocol);
    protocol->stimulus(question.stimulus);  // refused before the work if there is none
  }
  const core::ProgressHook hook = progress.hook();
  ResponseIdentification found;
  found.question = question;
  found.stimulus = question.stimulus;
  hook("modes");
  found.responses = analysis::find_response_modes(
      analysis::read_responses(question.files, question.kind), question.band);
  found.remarks = found.responses.remarks;
  const analysis::FrequencyResponses& measured = found.responses.measured;
  const Eigen::ArrayXd& hz = measured.frequency_hz;
  found.source = fmt::format("{} frequency responses, {}, {:g} to {:g} Hz", measured.pairs.size(),
                             name(measured.kind), hz[0], hz[hz.size() - 1]);
  for (const analysis::ResponseMode& mode : found.responses.modes) {
    found.modes.push_back(repeated(mode, measured.pairs.size()));
    if (mode.standing != analysis::Standing::agreed) {
      found.others.push_back(fmt::format("{:.6g} Hz, damping ratio {:.3g}: doubtful: {}",
                                         mode.frequency_hz.value, mode.damping_ratio.value,
                                         mode.why));
    }
  }
  sum_up_modes(found);
  if (protocol) {
    found.loop_rate_hz = protocol->rate_hz;
    compare(*protocol, hook, found);
  }
  return found;
}
}  // namespace tapstudy::runner
