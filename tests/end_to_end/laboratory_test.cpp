// `identify`: parameters planted in recordings of taps come back, in a form that a protocol takes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/model/modes/damping.hpp"
#include "core/model/plate_model.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/synthetic_taps.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using Json = nlohmann::json;

namespace {
const std::string damping_line = "    damping: {alpha_per_s: 10, beta_s: 1.0e-5}\n";
const std::string material =
    "  board:\n    youngs_modulus_pa: 3.0e9\n    density_kg_per_m3: 700\n    poissons_ratio: "
    "0.3\n" +
    damping_line;
const std::string shelf = R"(format: tapstudy/1
title: A plate to identify
finger: {mass_kg: 0.02, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering:
  rate_hz: 4000
  penalty_stiffness_n_per_m: 3000
  band_limit_hz: 350
placement: {origin_m: [0, 0, 0], lateral_scale: 0.1}
materials:
)" + material + R"(plates:
  shelf:
    size_m: [0.4, 0.25, 0.012]
    mesh: {order: 2, max_tet_volume_m3: 2.0e-5}
    fixations:
      - {region: side, side: left}
tapping_points_m: {P1: [0.1, 0.05]}
stimuli:
  shelf: {label: shelf, plate: shelf, material: board, technique: fem}
  other: {label: other, plate: shelf, material: board, technique: none}
blocks:
  - {name: main, task: identification, question: Which, stimuli: [shelf, other]}
)";
const std::vector<double> tap_times_s{0.5, 2.0, 3.4, 5.0, 6.1};
const std::vector<double> speeds_m_s{0.2, 0.35, 0.3, 0.5, 0.25};
constexpr double rate_hz = 4000.0;

// The shelf's own frequencies, as the program computes them for 3 GPa.
std::vector<double> frequencies_of_model(const std::string& protocol) {
  const auto run = testing::tapstudy({"modes", protocol, "--stimulus", "shelf", "--json"});
  REQUIRE(run.exit_code == 0);
  return Json::parse(run.standard_output)["frequencies_hz"].get<std::vector<double>>();
}

std::string recording_text(const std::vector<testing::PlantedMode>& modes) {
  core::Rng rng{12};
  std::string text = "time_s,acceleration\n";
  for (int n = 0; n < 30000; ++n) {
    const double t_s = n / rate_hz;
    double value = 0.002 * rng.normal();
    for (std::size_t i = 0; i < tap_times_s.size(); ++i) {
      if (t_s >= tap_times_s[i]) {
        value += speeds_m_s[i] * testing::ringing(modes, t_s - tap_times_s[i]);
      }
    }
    text += fmt::format("{:.6f},{:.7g}\n", t_s, value);
  }
  return text;
}

struct Case {
  testing::TempDirectory directory;
  std::string protocol = directory / "shelf.yaml";
  std::string recording = directory / "taps.csv";
  std::string out = directory / "identified";
  std::vector<testing::PlantedMode> planted;

  // Modes of a material with this factor on Young's modulus, each damped by ratio_at.
  template <class RatioAt>
  void record(double modulus_factor, const RatioAt& ratio_at) {
    testing::write(protocol, shelf);
    std::vector<testing::PlantedMode> modes;
    for (const double model_hz : frequencies_of_model(protocol)) {
      const double frequency_hz = model_hz * std::sqrt(modulus_factor);
      modes.push_back({{frequency_hz, ratio_at(frequency_hz)},
                       1.0 / (1.0 + 0.3 * static_cast<double>(modes.size()))});
    }
    REQUIRE(modes.size() == 4);
    testing::write(recording, recording_text(modes));
    planted = modes;
  }
  testing::ProgramResult identify(std::vector<std::string> more) const {
    more.insert(more.begin(), {"identify", recording, "--out", out, "--band", "15:350"});
    return testing::tapstudy(more);
  }
  std::string yaml() const { return testing::contents(out + "/identified.yaml"); }
  Json json() const { return Json::parse(testing::contents(out + "/identified.json")); }
};

double rayleigh_ratio(double frequency_hz) {
  const double omega = 2.0 * std::numbers::pi * frequency_hz;
  return core::damping_ratios({6.0, 2e-5}, Eigen::ArrayXd::Constant(1, omega))[0];
}

// What follows a line "key:" of identified.yaml, up to the next line that is not indented.
std::string section(const std::string& yaml, const std::string& key) {
  const std::size_t begin = yaml.find('\n' + key + ":\n");
  REQUIRE(begin != std::string::npos);
  std::string text;
  for (std::size_t at = yaml.find('\n', begin + 1) + 1; at < yaml.size() && yaml[at] == ' ';) {
    const std::size_t end = yaml.find('\n', at) + 1;
    text += yaml.substr(at, end - at);
    at = end;
  }
  return text;
}
}  // namespace

TEST_CASE("recorded taps are played back by the technique that plays recordings",
          "[end_to_end][identify][recorded]") {
  Case played;
  played.record(1.0, [](double) { return 0.02; });
  const std::string speeds = played.directory / "speeds.csv";
  testing::write(speeds, "speed_m_s\n0.2\n0.35\n0.3\n0.5\n0.25\n");
  const std::vector<std::string> asked{"--protocol", played.protocol, "--stimulus",
                                       "shelf",      "--at",          "0.1,0.05"};
  const auto refused = played.identify(asked);
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error, Contains("--at needs --speeds"));
  auto with_speeds = asked;
  with_speeds.insert(with_speeds.end(), {"--speeds", speeds});
  REQUIRE(played.identify(with_speeds).exit_code == 0);

  std::string study = testing::contents(played.out + "/recordings.yaml");
  study = study.substr(study.find("recordings:")) + "tapping_points_m:";
  study = testing::replaced(shelf, "tapping_points_m:", study);
  study = testing::replaced(study, "technique: none}", "technique: recorded, recording: shelf}");
  testing::write(played.protocol, study);
  const protocols::Protocol protocol = protocols::read_protocol(played.protocol);
  REQUIRE(protocol.stimulus("other").recording->taps.size() == 5);
  const core::RecordedTap& tap = protocol.stimulus("other").recording->taps.front();
  CHECK(tap.speed_m_s == 0.2);
  // the onset is found to a few samples
  double least = HUGE_VAL;
  for (int shift = -3; shift <= 3; ++shift) {
    double planted_n2 = 0.0;
    double difference_n2 = 0.0;
    for (int n = 3; n < 1000; ++n) {
      const double planted_n = 0.02 * 0.2 * testing::ringing(played.planted, (n + shift) / rate_hz);
      const double played_n = tap.force_n.at(static_cast<std::size_t>(n));
      planted_n2 += planted_n * planted_n;
      difference_n2 += (planted_n - played_n) * (planted_n - played_n);
    }
    least = std::min(least, std::sqrt(difference_n2 / planted_n2));
  }
  CHECK(least < 0.05);
  const auto run =
      testing::tapstudy({"tap", played.protocol, "--stimulus", "other", "--at", "0.1,0.05"});
  INFO(run.standard_error);
  CHECK(run.exit_code == 0);
}

TEST_CASE("how stiff a shelf's springs are is found with its Young's modulus",
          "[end_to_end][identify]") {
  Case shelf_on_springs;
  const auto on_springs = [](const std::string& springs) {
    return testing::replaced(shelf, "side: left}", "side: left, springs_n_per_m: " + springs + "}");
  };
  testing::write(shelf_on_springs.protocol,
                 testing::replaced(on_springs("[1.0e6, 1.0e6, 2.0e5]"), "3.0e9", "3.3e9"));
  std::vector<testing::PlantedMode> modes;
  for (const double hz : frequencies_of_model(shelf_on_springs.protocol)) {
    modes.push_back({{hz, 0.02}, 1.0 / (1.0 + 0.3 * static_cast<double>(modes.size()))});
  }
  REQUIRE(modes.size() >= 4);
  testing::write(shelf_on_springs.recording, recording_text(modes));
  testing::write(shelf_on_springs.protocol, on_springs("[2.0e6, 2.0e6, 4.0e5]"));
  const auto run =
      shelf_on_springs.identify({"--protocol", shelf_on_springs.protocol, "--stimulus", "shelf"});
  INFO(run.standard_output << run.standard_error);
  REQUIRE(run.exit_code == 0);
  const Json model = shelf_on_springs.json()["model"];
  CHECK(model["spring_factor"]["value"].get<double>() == Approx(0.5).epsilon(0.02));
  CHECK(model["youngs_modulus_pa"]["value"].get<double>() == Approx(3.3e9).epsilon(0.01));
  CHECK_THAT(run.standard_output, Contains("times as stiff as the protocol's"));
  const std::string yaml = shelf_on_springs.yaml();
  INFO(yaml);
  const std::string fixations = section(yaml, "plates");
  const protocols::Protocol pasted = protocols::parse_protocol(
      testing::replaced(shelf, "    fixations:\n      - {region: side, side: left}\n",
                        fixations.substr(fixations.find("    fixations:"))),
      "pasted.yaml");
  const core::Fixation& held = pasted.plates.at("shelf")->fixations.at(0);
  CHECK(held.side == core::Side::left);
  CHECK(held.springs_n_per_m->z() == Approx(2.0e5).epsilon(0.02));
}

namespace {
// The model's own shapes, at nodes of its upper face: of each place one value a mode.
struct PlacesOfShelf {
  std::vector<Eigen::Vector2d> at_m;
  Eigen::MatrixXd shapes;  // a row for each place
  Eigen::ArrayXd frequencies_hz;
};
PlacesOfShelf places_of(const std::string& protocol_file) {
  const protocols::Protocol protocol = protocols::read_protocol(protocol_file);
  const protocols::PresentedStimulus presented =
      protocols::stimulus_with(protocol, protocol.stimulus("shelf"));
  const core::ModalModel modal =
      core::build_plate_model(runner::plate_spec(protocol, presented)).modal;
  PlacesOfShelf places;
  places.frequencies_hz = modal.frequency_hz;
  std::vector<Eigen::Index> nodes;
  const std::vector<Eigen::Vector2d> wanted_m{{0.2, 0.06},  {0.2, -0.06}, {0.1, 0.0},
                                              {0.05, 0.06}, {0.0, -0.03}, {-0.05, 0.03}};
  for (const Eigen::Vector2d& wanted : wanted_m) {
    Eigen::Index nearest = -1;
    for (Eigen::Index node = 0; node < modal.touch_nodes_m.rows(); ++node) {
      const auto distance = [&](Eigen::Index of) {
        return (modal.touch_nodes_m.row(of).head<2>().transpose() - wanted).norm();
      };
      if (modal.touch_nodes_m(node, 2) > -1e-9 &&
          (nearest < 0 || distance(node) < distance(nearest))) {
        nearest = node;
      }
    }
    places.at_m.emplace_back(modal.touch_nodes_m.row(nearest).head<2>());
    nodes.push_back(nearest);
  }
  places.shapes.resize(static_cast<Eigen::Index>(nodes.size()), modal.frequency_hz.size());
  for (std::size_t place = 0; place < nodes.size(); ++place) {
    places.shapes.row(static_cast<Eigen::Index>(place)) = modal.shape.row(3 * nodes[place] + 2);
  }
  return places;
}

double ratio_of_rung(std::size_t mode) {
  return mode == 1 ? 0.008 : 0.02;
}

// A tap at each place in turn, of another speed each; mode i rings at frequencies_hz[i] with the
// shape of the model's mode shape_of[i]. Two sensors, of which the second stands where everything
// is smaller and the other way round, and the force of what struck.
std::string roving_taps(const PlacesOfShelf& places, const std::vector<double>& frequencies_hz,
                        const std::vector<Eigen::Index>& shape_of) {
  constexpr double apart_s = 1.5;
  constexpr double lasts_s = 0.003;
  core::Rng rng{13};
  std::string text = "time_s,near,far,force\n";
  const auto count =
      static_cast<int>((0.5 + apart_s * static_cast<double>(places.at_m.size())) * rate_hz);
  for (int n = 0; n < count; ++n) {
    const double t_s = n / rate_hz;
    double value = 0.0;
    double force_n = 0.3;  // the hammer's cable
    for (std::size_t place = 0; place < places.at_m.size(); ++place) {
      // at no time of the grid's
      const double since_s = t_s - 0.4 - (apart_s + 0.00013) * static_cast<double>(place);
      const double speed_m_s = speeds_m_s[place % speeds_m_s.size()];
      if (since_s >= 0.0 && since_s < lasts_s) {
        force_n += 30.0 * speed_m_s * std::sin(std::numbers::pi * since_s / lasts_s);
      }
      // what a half sine excites, as after one impulse at its middle
      for (std::size_t mode = 0; since_s >= lasts_s && mode < frequencies_hz.size(); ++mode) {
        const double shape = places.shapes(static_cast<Eigen::Index>(place), shape_of[mode]);
        value += speed_m_s * shape *
                 testing::ringing({{{frequencies_hz[mode], ratio_of_rung(mode)}, 1.0}},
                                  since_s - 0.5 * lasts_s);
      }
    }
    text += fmt::format("{:.6f},{:.7g},{:.7g},{:.7g}\n", t_s, value + 0.0005 * rng.normal(),
                        -0.4 * value + 0.0005 * rng.normal(), force_n);
  }
  return text;
}
}  // namespace

namespace {
std::vector<double> modal_ratios_in(const std::string& yaml) {
  const std::string text = testing::contents(yaml);
  const std::string key = "modal_ratios: [";
  const auto begin = text.find(key) + key.size();
  REQUIRE(begin != std::string::npos + key.size());
  std::istringstream list{text.substr(begin, text.find(']', begin) - begin)};
  std::vector<double> ratios;
  for (std::string one; std::getline(list, one, ',');) {
    ratios.push_back(std::stod(one));
  }
  return ratios;
}
}  // namespace

TEST_CASE("modes whose shapes are known by the places tapped are matched by them, too",
          "[end_to_end][identify]") {
  Case shelf_taps;
  // narrow enough that the second bending and the first twisting mode lie within 7 %
  testing::write(shelf_taps.protocol,
                 testing::replaced(testing::replaced(shelf, "0.4, 0.25, 0.012", "0.4, 0.12, 0.012"),
                                   "P1: [0.1, 0.05]", "P1: [0.1, 0.03]"));
  const PlacesOfShelf places = places_of(shelf_taps.protocol);
  REQUIRE(places.frequencies_hz.size() == 4);
  // these two have changed places, as where the model is a little wrong
  const std::vector<double> rung_hz(places.frequencies_hz.begin(), places.frequencies_hz.end());
  REQUIRE(rung_hz[2] < 1.1 * rung_hz[1]);
  const std::vector<Eigen::Index> shape_of{0, 2, 1, 3};
  testing::write(shelf_taps.recording, roving_taps(places, rung_hz, shape_of));
  std::string table = "x_m,y_m,speed_m_s\n";
  for (std::size_t i = 0; i < places.at_m.size(); ++i) {
    table += fmt::format("{:.9g},{:.9g},{}\n", places.at_m[i].x(), places.at_m[i].y(),
                         speeds_m_s[i % speeds_m_s.size()]);
  }
  const std::string impacts = shelf_taps.directory / "impacts.csv";
  testing::write(impacts, table);
  const std::vector<std::string> model{"--protocol", shelf_taps.protocol, "--stimulus", "shelf"};
  auto asked = model;
  asked.insert(asked.end(), {"--places", impacts});
  const auto refused = shelf_taps.identify(asked);
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error, Contains("--places needs --force-column or --speeds"));
  SECTION("with impulses in proportion to speeds, and one sensor") {
    asked.insert(asked.end(), {"--speeds", impacts, "--column", "near"});
  }
  SECTION("with impulses of the force, and two sensors") {
    asked.insert(asked.end(), {"--force-column", "force", "--column", "far", "near"});
  }
  const auto run = shelf_taps.identify(asked);
  INFO(run.standard_output << run.standard_error);
  REQUIRE(run.exit_code == 0);
  const Json json = shelf_taps.json();
  REQUIRE(json["model"]["matched"].size() == 3);  // the fourth moves sideways
  for (const Json& tap : json["taps"]) {
    if (tap.contains("impulse_n_s")) {
      const double speed_m_s = speeds_m_s[(tap["impact"].get<std::size_t>() - 1) % 5];
      // a half sine of 3 ms
      CHECK(tap["impulse_n_s"].get<double>() ==
            Approx(30.0 * speed_m_s * 0.006 / std::numbers::pi).epsilon(0.03));
    }
  }
  for (const Json& one : json["model"]["matched"]) {
    CAPTURE(one.dump());
    CHECK(one["model_mode"] == shape_of.at(one["agreed_mode"].get<std::size_t>()));
    CHECK(one["mac"].get<double>() > 0.98);
  }
  const std::vector<double> ratios = modal_ratios_in(shelf_taps.out + "/identified.yaml");
  REQUIRE(ratios.size() >= 3);
  CHECK(ratios[0] == Approx(0.02).epsilon(0.05));
  CHECK(ratios[1] == Approx(0.02).epsilon(0.05));   // which rang third
  CHECK(ratios[2] == Approx(0.008).epsilon(0.05));  // second
}

namespace {
// Receptances of all places by a force at the first, which rings as roving_taps does; the third
// sensor is mounted upside down, and the first has a second axis.
std::string measured_responses(const PlacesOfShelf& places,
                               const std::vector<double>& frequencies_hz,
                               const std::vector<Eigen::Index>& shape_of) {
  std::string text = "frequency_hz,9+X/1+Z real,9+X/1+Z imag";
  for (std::size_t place = 0; place < places.at_m.size(); ++place) {
    text += fmt::format(",{0}{1}Z/1+Z real,{0}{1}Z/1+Z imag", place + 1, place == 2 ? '-' : '+');
  }
  for (int line = 40; line <= 1200; ++line) {
    const double hz = 0.25 * line;
    text += fmt::format("\n{:g}", hz);
    std::vector<std::complex<double>> row(places.at_m.size() + 1);
    for (std::size_t mode = 0; mode < frequencies_hz.size(); ++mode) {
      const double own_hz = frequencies_hz[mode];
      const std::complex<double> motion =
          1.0 / std::complex{own_hz * own_hz - hz * hz, 2.0 * ratio_of_rung(mode) * own_hz * hz};
      const auto shape = places.shapes.col(shape_of[mode]);
      row[0] += 0.3 * shape[0] * shape[0] * motion;
      for (std::size_t place = 0; place < places.at_m.size(); ++place) {
        row[place + 1] +=
            (place == 2 ? -1.0 : 1.0) * shape[static_cast<Eigen::Index>(place)] * shape[0] * motion;
      }
    }
    for (const std::complex<double>& value : row) {
      text += fmt::format(",{:.8g},{:.8g}", value.real(), value.imag());
    }
  }
  return text + "\n";
}
}  // namespace

TEST_CASE("modes of frequency responses are matched by the shapes at places that are stated",
          "[end_to_end][identify]") {
  Case measured;
  testing::write(measured.protocol,
                 testing::replaced(testing::replaced(shelf, "0.4, 0.25, 0.012", "0.4, 0.12, 0.012"),
                                   "P1: [0.1, 0.05]", "P1: [0.1, 0.03]"));
  const PlacesOfShelf places = places_of(measured.protocol);
  const std::vector<double> hz(places.frequencies_hz.begin(), places.frequencies_hz.begin() + 3);
  const std::vector<Eigen::Index> shape_of{0, 2, 1};  // as where the model is a little wrong
  measured.recording = measured.directory / "responses.csv";
  testing::write(measured.recording, measured_responses(places, hz, shape_of));
  std::string table = "place,x_m,y_m\n";
  for (std::size_t i = 0; i < places.at_m.size(); ++i) {
    table += fmt::format("{},{:.9g},{:.9g}\n", i + 1, places.at_m[i].x(), places.at_m[i].y());
  }
  const std::string stated = measured.directory / "places.csv";
  std::vector<std::string> asked{"--response", "receptance", "--places", stated};
  testing::write(stated, table);
  CHECK_THAT(measured.identify(asked).standard_error, Contains("--places needs --protocol"));
  asked.insert(asked.end(), {"--protocol", measured.protocol, "--stimulus", "shelf"});
  testing::write(stated, table + "17,0,0\n");
  CHECK_THAT(measured.identify(asked).standard_error, Contains("no response is of the place '17'"));
  testing::write(stated, table);
  const auto run = measured.identify(asked);
  INFO(run.standard_output << run.standard_error);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.standard_output, Contains("shapes are compared at 6 of 7 places"));
  const Json model = measured.json()["model"];
  REQUIRE(model["matched"].size() == hz.size());
  for (const Json& one : model["matched"]) {
    CAPTURE(one.dump(), model["mac"].dump());
    const auto mode = one["agreed_mode"].get<std::size_t>();
    CHECK(one["model_mode"] == shape_of.at(mode));
    CHECK(one["mac"].get<double>() > 0.999);
    CHECK(one["mac"] == model["mac"][mode][static_cast<std::size_t>(shape_of.at(mode))]);
  }
  const std::string rows = testing::contents(measured.out + "/mac.csv");
  CHECK(std::ranges::count(rows, '\n') == 1 + 3 * std::ssize(places.frequencies_hz));
  CHECK_THAT(testing::contents(measured.out + "/mac.svg"), Contains("<svg"));
}

TEST_CASE("Young's modulus, damping and modes of a shelf are found in recordings of its taps",
          "[identify][end_to_end][slow]") {
  Case shelf_taps;
  constexpr double factor = 1.08;
  shelf_taps.record(factor, rayleigh_ratio);
  testing::write(shelf_taps.directory / "speeds.csv", [] {
    std::string text = "speed_m_s\n";
    for (const double speed_m_s : speeds_m_s) {
      text += fmt::format("{}\n", speed_m_s);
    }
    return text;
  }());
  const auto run = shelf_taps.identify({"--protocol", shelf_taps.protocol, "--stimulus", "shelf",
                                        "--speeds", shelf_taps.directory / "speeds.csv"});
  INFO(run.standard_output << run.standard_error);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.standard_output, Contains("5 taps") && Contains("Young's modulus") &&
                                      Contains("holds its fixations rigidly"));
  const Json json = shelf_taps.json();
  REQUIRE(json["taps"].size() == tap_times_s.size());
  CHECK(std::ranges::count(json["modes"], "agreed",
                           [](const Json& m) { return m["standing"].get<std::string>(); }) == 4);
  const Json& modulus = json["model"]["youngs_modulus_pa"];
  CHECK(modulus["value"].get<double>() == Approx(factor * 3.0e9).epsilon(1e-3));
  CHECK(json["model"]["matched"].size() == 4);
  CHECK(json["rayleigh"]["alpha_per_s"]["value"].get<double>() == Approx(6.0).epsilon(0.03));
  CHECK(json["rayleigh"]["beta_s"]["value"].get<double>() == Approx(2e-5).epsilon(0.03));
  for (const std::string name : {"time.svg", "spectrum.svg", "stabilisation.svg"}) {
    CHECK_THAT(testing::contents(shelf_taps.out + "/" + name), Contains("</svg>"));
  }

  const std::string yaml = shelf_taps.yaml();
  INFO(yaml);
  std::string pasted = testing::replaced(shelf, material, section(yaml, "materials"));
  pasted = testing::replaced(pasted, "rendering:\n", "rendering:\n" + section(yaml, "rendering"));
  const protocols::Protocol protocol = protocols::parse_protocol(pasted, "pasted.yaml");
  const protocols::Material& board = *protocol.materials.at("board");
  CHECK(board.youngs_modulus_pa == Approx(modulus["value"].get<double>()).epsilon(1e-4));
  CHECK(board.density_kg_per_m3 == 700.0);
  CHECK(std::get<core::RayleighDamping>(board.damping).alpha_per_s == Approx(6.0).epsilon(0.03));
  const core::SinusoidShape& sinusoid = protocol.rendering.sinusoid;
  CHECK(sinusoid.decay_per_s ==
        Approx(json["sinusoid"]["decay_per_s"]["value"].get<double>()).epsilon(1e-4));
  // acceleration / s^2 is felt through the finger's spring and damper
  const std::complex<double> pole{-sinusoid.decay_per_s,
                                  2.0 * std::numbers::pi * sinusoid.frequency_hz};
  const core::Finger& finger = protocol.rendering.finger;
  const double newtons_per_unit =
      std::abs((finger.stiffness_n_per_m + finger.damping_n_s_per_m * pole) / (pole * pole));
  CHECK(sinusoid.amplitude_n_s_per_m ==
        Approx(newtons_per_unit * json["sinusoid"]["amplitude_per_speed"]["value"].get<double>())
            .epsilon(1e-3));
}

TEST_CASE("damping that Rayleigh's cannot be is given mode by mode",
          "[identify][end_to_end][slow]") {
  Case shelf_taps;
  // falls and rises: highest in the middle
  shelf_taps.record(1.0, [](double frequency_hz) {
    return frequency_hz < 60.0 ? 0.01 : frequency_hz < 120.0 ? 0.04 : 0.012;
  });
  SECTION("for the modes of the model, where there is one") {
    const auto run =
        shelf_taps.identify({"--protocol", shelf_taps.protocol, "--stimulus", "shelf"});
    REQUIRE(run.exit_code == 0);
    CHECK_THAT(run.standard_output, Contains("does not fit"));
    const std::string yaml = shelf_taps.yaml();
    INFO(yaml);
    const protocols::Protocol protocol = protocols::parse_protocol(
        testing::replaced(shelf, material, section(yaml, "materials")), "pasted.yaml");
    const auto damping =
        std::get<core::ModalDamping>(protocol.materials.at("board")->damping).ratios;
    REQUIRE(damping.size() == 4);
    CHECK(damping[0] == Approx(0.01).epsilon(0.05));
    CHECK(damping[1] == Approx(0.04).epsilon(0.05));
    CHECK(damping[2] == Approx(0.012).epsilon(0.05));
  }
  SECTION("beside the measured frequencies, without a protocol that says which mode is which") {
    const auto run = shelf_taps.identify({});
    REQUIRE(run.exit_code == 0);
    CHECK(run.standard_output.find("Modes") < run.standard_output.find("recording"));
    const std::string yaml = shelf_taps.yaml();
    INFO(yaml);
    CHECK_THAT(yaml, Contains("modal_ratios are not offered"));
    CHECK(yaml.find("\ndamping:") == std::string::npos);  // nothing that would be wrong
    const Json json = shelf_taps.json();
    REQUIRE(json["modes"].size() >= 3);
    for (const Json& mode : json["modes"]) {
      CHECK_THAT(yaml, Contains(fmt::format("{:.6g} Hz: {:.5g}",
                                            mode["frequency_hz"]["value"].get<double>(),
                                            mode["damping_ratio"]["value"].get<double>())));
    }
  }
}

TEST_CASE("what cannot be identified is refused in words, and leaves nothing behind",
          "[identify][end_to_end]") {
  Case noise;
  core::Rng rng{1};
  std::string text = "acceleration\n";
  for (int n = 0; n < 5000; ++n) {
    text += fmt::format("{:.5f}\n", rng.normal());
  }
  testing::write(noise.recording, text);
  testing::write(noise.protocol, shelf);
  const auto refused = [&](std::vector<std::string> more, const std::string& words) {
    const auto run = noise.identify(std::move(more));
    INFO(words);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.standard_error, Contains(words));
    CHECK_FALSE(std::filesystem::exists(noise.out));
  };
  refused({}, "give the rate by --rate HZ");
  refused({"--rate", "4000"}, "holds no tap");
  refused({"--rate", "400"}, "--band: ends at 350 Hz");
  refused({"--rate", "4000", "--stimulus", "shelf"}, "--protocol and --stimulus go together");
  refused({"--rate", "4000", "--protocol", noise.protocol, "--stimulus", "no"}, "shelf");
  std::filesystem::create_directory(noise.out);
  const auto run = noise.identify({"--rate", "4000"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("exists already"));
}

TEST_CASE("a force that does not strike, or is taken for a sensor, is refused in one line",
          "[end_to_end][identify]") {
  Case shelf_taps;
  shelf_taps.record(1.0, [](double) { return 0.02; });
  std::string with_force = "time_s,acceleration,force\n";
  std::istringstream lines{testing::contents(shelf_taps.recording)};
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    with_force += line + ",1.5\n";
  }
  testing::write(shelf_taps.recording, with_force);
  const auto refused = [&](const std::vector<std::string>& asked, const std::string& words) {
    const auto run = shelf_taps.identify(asked);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.standard_error, Contains(words));
    CHECK_FALSE(std::filesystem::exists(shelf_taps.out));
  };
  refused({"--column", "acceleration", "--force-column", "force"},
          "holds no tap: all samples are the same (the force, force)");
  refused({"--column", "force", "--force-column", "force"}, "'force' is named twice");
}

// `reproduce`: what it writes and where it refuses to.
using testing::TempDirectory;

namespace {
testing::ProgramResult reproduced(const std::string& directory) {
  return testing::tapstudy({"reproduce", "--only", "plate", "--quick", "--out", directory});
}
}  // namespace

TEST_CASE("a reproduction fits the schema that is shipped, and every verdict its numbers",
          "[end_to_end][reproduction]") {
  const TempDirectory directory;
  const std::string out = directory / "paper";
  const auto run = reproduced(out);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.standard_error, Contains("1 of 1: The plate model"));
  CHECK(std::filesystem::exists(out + "/reproduction.html"));
  const auto fits =
      testing::run_program({"/usr/bin/python3", testing::source("tests/protocols/validate.py"),
                            testing::source("runner/laboratory/reproduce/reproduction.schema.json"),
                            out + "/reproduction.json"});
  INFO(fits.standard_error);
  CHECK(fits.exit_code == 0);
  const auto json = nlohmann::json::parse(testing::contents(out + "/reproduction.json"));
  CHECK(json["command"] == "tapstudy reproduce --only plate --quick --seed 1 --out DIR");
  for (const auto& claim : json["claims"]) {
    INFO(claim["name"]);
    std::size_t confirming = 0;
    std::size_t judging = 0;
    for (const auto& method : claim["methods"]) {
      bool confirms = method["judges"];
      for (const auto& measure : method["measures"]) {
        const bool holds =
            (measure["at_least"].is_null() || measure["value"] >= measure["at_least"]) &&
            (measure["at_most"].is_null() || measure["value"] <= measure["at_most"]);
        CHECK(measure["holds"] == holds);
        confirms = confirms && holds;
      }
      CHECK(method["confirms"] == confirms);
      confirming += confirms ? 1 : 0;
      judging += method["judges"] ? 1 : 0;
    }
    CHECK(claim["verdict"] == (judging == 0                   ? "shown"
                               : claim["unknown_input"] != "" ? "depends"
                               : confirming == 0              ? "false"
                               : confirming == judging        ? "true"
                                                              : "depends"));
  }
}

TEST_CASE("a reproduction replaces nothing, and says at once where it cannot be written",
          "[end_to_end][reproduction]") {
  const TempDirectory directory;
  for (const char* const name : {"reproduction.html", "reproduction.json"}) {
    const std::string taken = directory / (std::string{"taken_"} + name);
    std::filesystem::create_directory(taken);
    testing::write(std::filesystem::path{taken} / name, "mine");
    const auto run = reproduced(taken);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.standard_error, Contains(name));
    CHECK_THAT(run.standard_error, !Contains("1 of 1"));
    CHECK(testing::contents(std::filesystem::path{taken} / name) == "mine");
    CHECK(testing::entries(taken) == 1);
  }
  testing::write(directory / "file", "");
  for (const std::string& nowhere : {directory / "file", std::string{"/proc/nowhere"}}) {
    const auto run = reproduced(nowhere);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.standard_error, Contains("cannot be made"));
    CHECK_THAT(run.standard_error, !Contains("1 of 1"));
  }
  const auto unknown = testing::tapstudy({"reproduce", "--only", "x", "--out", directory / "new"});
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.standard_error, Contains("one of: plate, modes"));
}
