#include "protocols/reader/tap_script.hpp"

#include "protocols/reader/read_sections.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;
using Action = TapStep::Action;
constexpr double long_script_s = 600.0;
const Range speeds_m_s{1e-3, 10.0};
const Range forces_n{0.0, 100.0};

Eigen::Vector2d read_place(MapReader& reader, const Plate& plate) {
  if (reader.has("point") && reader.has("place_m")) {
    reader.reject("place_m", "stands beside point (one of the two)");
  }
  if (!reader.has("point")) {
    return reader.numbers({"place_m", "place in the plate frame, instead of point"}, 2,
                          {-100.0, 100.0});
  }
  const std::string point =
      reader.word({"point", "name of a tapping point of the plate, instead of place_m"},
                  "tapping point", keys_of(plate.tapping_points_m));
  const auto found = plate.tapping_points_m.find(point);
  return found == plate.tapping_points_m.end() ? Eigen::Vector2d{Eigen::Vector2d::Zero()}
                                               : found->second;
}

TapStep read_step(MapReader& reader, const Plate& plate) {
  TapStep step;
  step.stated_at = reader.stated_at();
  step.action = reader.one_of<Action>(
      {"do", "strike and slide end at a place; press changes the force; release lifts the finger"},
      {{"strike", Action::strike},
       {"press", Action::press},
       {"slide", Action::slide},
       {"release", Action::release}});
  if (reader.has("start_s")) {
    step.start_s = reader.number({"start_s", "when a strike hits; unset: as soon as it can"},
                                 {0.0, long_script_s});
  }
  if (step.action == Action::strike || step.action == Action::slide) {
    step.place_m = read_place(reader, plate);
  }
  if (step.action == Action::strike || step.action == Action::press) {
    step.force_n = reader.number({"force_n", "force at rest, of a strike and a press"}, forces_n);
  }
  if (step.action == Action::press) {
    step.duration_s = reader.number({"duration_s", "of a press, until the force is reached"},
                                    {1e-3, long_script_s});
  } else {
    step.speed_m_s = reader.number({"speed_m_s", "of all but a press"}, speeds_m_s);
  }
  return step;
}
}  // namespace

TapScript parse_tap_script(const std::string& text, const std::string& file, const Plate& plate) {
  Problems problems{file};
  MapReader top = MapReader::whole_file(text, file, problems);
  top.check_format("tapstudy-taps/1");
  TapScript script;
  script.rest_s =
      top.number({"rest_s", "how long the last contact is held"}, {0.0, long_script_s}, 0.3);
  bool is_down = false;
  top.list({"steps", "what the finger does, one after the other"}, Presence::at_least_one,
           [&](MapReader& reader) {
             const TapStep step = read_step(reader, plate);
             if (step.action == Action::strike && is_down) {
               reader.reject("do", "strikes with a finger that is down (release it first)");
             }
             if (step.action != Action::strike && !is_down) {
               reader.reject("do", "needs a finger that is down (strike first)");
             }
             is_down = step.action != Action::release;
             script.steps.push_back(step);
           });
  top.finish();
  problems.throw_if_any();
  return script;
}
}  // namespace tapstudy::protocols
