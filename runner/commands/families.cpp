#include "runner/commands/families.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/model/stopwatch.hpp"
#include "runner/experiments/counted.hpp"
#include "runner/stimuli/family.hpp"
namespace tapstudy::runner {
namespace {
double megabytes(const core::BodyModes& body) {
  const auto bytes = [](const auto& matrix) {
    return 1e-6 * static_cast<double>(sizeof(*matrix.data())) * static_cast<double>(matrix.size());
  };
  return bytes(body.shape) + bytes(body.touch_nodes_m) + bytes(body.touch_surface);
}

void print_crossings(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                     const core::BodyModes& body) {
  for (const protocols::AxisRange& range : stimulus.vary) {
    const auto crossings = band_crossings(protocol, stimulus, range, body);
    if (!crossings.empty()) {
      fmt::print(
          "    note: a mode crosses the band limit at {} {:.3g}{}: a difference across such a "
          "value "
          "is told by the mode\n",
          range.axis->name, fmt::join(crossings, ", "),
          range.axis->unit.empty() ? "" : fmt::format(" {}", range.axis->unit));
    }
  }
}

void print_cost(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                ModelLibrary& models) {
  const BandEnds ends = band_ends(protocol, stimulus);
  double solved_s = 0.0;
  double held_mb = 0.0;
  const auto bodies = models.bodies_of(protocol, stimulus);
  for (const ModelLibrary::Body& body : bodies) {
    solved_s += body->report.cost.total_s();
    held_mb += megabytes(*body);
  }
  core::Stopwatch watch;
  const auto most = models.plate_of(protocol, stimulus_with(protocol, stimulus, ends.most));
  const double member_s = watch.elapsed_s();
  const auto fewest = models.plate_of(protocol, stimulus_with(protocol, stimulus, ends.fewest));
  fmt::print("    {}, solved in {:.3f} s, {:.1f} MB; a member takes {:.1f} ms more\n",
             counted(bodies.size(), "model"), solved_s, held_mb, 1e3 * member_s);
  const auto least = static_cast<std::size_t>(fewest->model.frequency_hz.size());
  const auto greatest = static_cast<std::size_t>(most->model.frequency_hz.size());
  fmt::print("    {}{} below {} Hz at its own values of table axes\n",
             least == greatest ? "" : fmt::format("{} to ", least), counted(greatest, "mode"),
             protocol.band_limit_hz);
  print_crossings(protocol, stimulus, *models.body_of(protocol, stimulus_with(protocol, stimulus)));
}
}  // namespace

void print_families(const protocols::Protocol& protocol, ModelLibrary& models) {
  models.build_all(protocol);
  bool is_first = true;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (stimulus.vary.empty()) {
      continue;
    }
    fmt::print("{}", is_first ? "\nfamilies\n" : "");
    is_first = false;
    std::vector<std::string> axes;
    std::ranges::transform(stimulus.vary, std::back_inserter(axes),
                           &protocols::AxisRange::described);
    fmt::print("  {}: {}\n", stimulus.name, fmt::join(axes, "; "));
    if (stimulus.technique->needs_model()) {
      print_cost(protocol, stimulus, models);
    } else {
      fmt::print("    no model: settings alone\n");
    }
  }
}

double largest_contact_stiffness_n_per_m(const protocols::Protocol& protocol) {
  double largest = protocol.rendering.penalty_stiffness_n_per_m;
  const auto consider = [&](const protocols::Stimulus& stimulus,
                            const core::RenderSettings& settings) {
    largest = std::max(largest, settings.penalty_stiffness_n_per_m +
                                    stimulus.technique->added_stiffness_n_per_m(settings));
  };
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    consider(stimulus, stimulus_with(protocol, stimulus).rendering);
    for (const protocols::AxisRange& range : stimulus.vary) {
      const auto member =
          stimulus_with(protocol, stimulus, {{std::string{range.axis->name}, range.to}});
      consider(stimulus, member.rendering);
    }
  }
  return largest;
}
}  // namespace tapstudy::runner
