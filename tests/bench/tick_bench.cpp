// One tick of fem+sinusoid on a finger that slides in contact, against the number of modes; the
// modes alone against a plain vector loop over the same state, and each technique against fem, as
// ratios of batches taken in turn.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/model/progress.hpp"
#include "core/random/rng.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/modal_state.hpp"
#include "support/surfaces.hpp"

using namespace tapstudy::core;
namespace {
constexpr double dt_s = 1e-3;

// A square face of 2 × side² triangles with made-up modes: the tick sees only numbers. Of order 2
// the middles of edges have nodes of their own.
ModalModel made_up_model(Eigen::Index modes, int side, int order = 1) {
  ModalModel model;
  Rng rng{1};
  model.frequency_hz = Eigen::ArrayXd::LinSpaced(modes, 20.0, 300.0);
  model.damping_ratio = Eigen::ArrayXd::Constant(modes, 0.02);
  model.touch_nodes_m.resize((side + 1) * (side + 1), 3);
  for (int j = 0; j <= side; ++j) {
    for (int i = 0; i <= side; ++i) {
      model.touch_nodes_m.row(j * (side + 1) + i) << 0.6 * i / side - 0.3, 0.6 * j / side - 0.3,
          0.0;
    }
  }
  model.touch_surface.resize(2 * side * side, 3);
  Eigen::Index row = 0;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const int low = j * (side + 1) + i;
      const int high = low + side + 1;
      model.touch_surface.row(row++) << low, low + 1, high + 1;
      model.touch_surface.row(row++) << low, high + 1, high;
    }
  }
  if (order == 2) {
    const auto corners = static_cast<int>(model.touch_nodes_m.rows());
    model.touch_surface.conservativeResize(Eigen::NoChange, 6);
    for (int i = 0; i < model.touch_surface.rows(); ++i) {
      model.touch_surface.row(i).tail<3>() << corners + 3 * i, corners + 3 * i + 1,
          corners + 3 * i + 2;
    }
    model.touch_nodes_m.conservativeResize(corners + 3 * model.touch_surface.rows(),
                                           Eigen::NoChange);
    model.touch_nodes_m.bottomRows(3 * model.touch_surface.rows()).setZero();
  }
  model.shape = ModalModel::Rows::NullaryExpr(3 * model.touch_nodes_m.rows(), modes,
                                              [&] { return rng.normal(); });
  return model;
}

RenderSettings settings() {
  RenderSettings all;
  all.sinusoid.amplitude_n_s_per_m = 3.0;
  all.recorded_taps = std::make_shared<const RecordedTaps>(
      RecordedTaps{1.0 / all.dt_s, {{{0.0, 0.0}, 0.3, std::vector<double>(300, 0.1)}}});
  return all;
}

// The median, over the iterations, of the time of `ours` per time of `theirs`, each called
// `batch` times in a row.
template <class Ours, class Theirs>
void compare(benchmark::State& state, const Ours& ours, const Theirs& theirs) {
  constexpr int batch = 1000;
  std::vector<double> ratios;
  for (auto _ : state) {
    Stopwatch watch;
    for (int i = 0; i < batch; ++i) {
      ours();
    }
    const double ours_s = watch.lap_s();
    for (int i = 0; i < batch; ++i) {
      theirs();
    }
    ratios.push_back(ours_s / watch.lap_s());
  }
  std::ranges::nth_element(ratios, ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2));
  state.counters["ratio"] = ratios[ratios.size() / 2];
}

// A finger that slides in contact.
class Slide {
 public:
  Slide(const Technique& technique, const VibratingPlate& plate)
      : renderer_{make_renderer(technique, settings(), PlateFace{0.3, 0.3}, &plate)} {
    renderer_.tick({{0.0, 0.0, 0.001}, {0.0, 0.0, -0.3}});
  }
  void operator()() {
    angle_ += 1e-3;
    benchmark::DoNotOptimize(renderer_.tick(
        {{0.2 * std::cos(angle_), 0.2 * std::sin(angle_), -0.001}, {0.0, 0.0, 0.0}}));
  }

 private:
  TapRenderer renderer_;
  double angle_{0.0};
};

// A tick of each technique over one of fem.
void technique_per_fem(benchmark::State& state) {
  const Technique& technique = techniques().at(static_cast<std::size_t>(state.range(0)));
  const VibratingPlate plate{made_up_model(state.range(1), 10, static_cast<int>(state.range(2)))};
  Slide ours{technique, plate};
  Slide fem{*find_technique("fem"), plate};
  state.SetLabel(std::string{technique.name});
  compare(
      state, [&] { ours(); }, [&] { fem(); });
}
BENCHMARK(technique_per_fem)
    ->ArgNames({"technique", "modes", "order"})
    ->ArgsProduct({benchmark::CreateDenseRange(0, static_cast<int>(techniques().size()) - 1, 1),
                   {14, 55, 220},
                   {2}});

void tick_in_contact(benchmark::State& state) {
  const VibratingPlate plate{made_up_model(state.range(0), static_cast<int>(state.range(1)),
                                           static_cast<int>(state.range(2)))};
  TapRenderer renderer =
      make_renderer(*find_technique("fem+sinusoid"), settings(), PlateFace{0.3, 0.3}, &plate);
  renderer.tick({{0.0, 0.0, 0.001}, {0.0, 0.0, -0.3}});
  double angle = 0.0;
  for (auto _ : state) {
    angle += 1e-3;
    const HandState tip{{0.2 * std::cos(angle), 0.2 * std::sin(angle), -0.001}, {0.0, 0.0, -0.3}};
    benchmark::DoNotOptimize(renderer.tick(tip));
  }
}
BENCHMARK(tick_in_contact)
    ->ArgNames({"modes", "side", "order"})
    ->Args({14, 10, 2})
    ->Args({55, 10, 1})
    ->Args({55, 10, 2})
    ->Args({220, 10, 2})
    ->Args({55, 100, 2});

// A finger that slides over a sphere of as many triangles, a centimetre inside.
void tick_on_surface(benchmark::State& state) {
  const TriangleTree sphere{
      tapstudy::testing::sphere_surface(0.1, static_cast<int>(state.range(0)))};
  SurfaceContact contact{sphere, 5e-4};
  const double triangles = static_cast<double>(sphere.surface().triangles.rows());
  double angle = 0.0;
  contact.tick({{0.102, 0.0, 0.0}, {-0.3, 0.0, 0.0}});
  for (auto _ : state) {
    angle += 3e-3;  // 0.3 m/s
    const HandState tip{
        {0.09 * std::cos(angle), 0.09 * std::sin(angle), 0.01 * std::sin(7 * angle)},
        {0.0, 0.0, 0.0}};
    benchmark::DoNotOptimize(contact.tick(tip));
  }
  state.counters["triangles"] = triangles;
  state.counters["touching"] = contact.now().touching ? 1.0 : 0.0;
}
BENCHMARK(tick_on_surface)->ArgName("rings")->Arg(10)->Arg(160);

// Loud start and silent tail of the modes alone.
void modal_core(benchmark::State& state) {
  const VibratingPlate plate{made_up_model(55, 10)};
  ModalState modes{plate.model, Integrator::exact, dt_s};
  modes.touch(plate.locator->locate(0.1, 0.1), {0.0, 0.0, 1.0});
  modes.strike(1.0);
  const bool is_silent = state.range(0) == 1;
  for (int tick = 0; is_silent && tick < 1'000'000; ++tick) {
    modes.tick();
  }
  for (auto _ : state) {
    modes.tick();
    benchmark::DoNotOptimize(modes.displacement_m());
    if (!is_silent) {
      modes.strike(1e-6);
    }
  }
}
BENCHMARK(modal_core)->ArgName("silent")->Arg(0)->Arg(1);

// What the modal core does, written by hand on arrays: an impulse that keeps all modes from
// decaying into denormals, the transition and the sum, in as many partial sums as a compiler can
// vectorise.
struct PlainModes {
  static constexpr std::size_t modes = 55;
  static constexpr std::size_t lanes = 4;
  std::array<double, modes> q{};
  std::array<double, modes> v{};
  std::array<double, modes> touched = filled(0.3);
  std::array<double, modes> qq = filled(0.99);
  std::array<double, modes> qv = filled(1e-3);
  std::array<double, modes> vq = filled(-0.5);
  std::array<double, modes> vv = filled(0.98);

  static std::array<double, modes> filled(double value) {
    std::array<double, modes> all{};
    all.fill(value);
    return all;
  }

  void tick() {
    for (std::size_t i = 0; i < modes; ++i) {
      const double before = q[i];
      q[i] = qq[i] * before + qv[i] * v[i];
      v[i] = vq[i] * before + vv[i] * v[i];
    }
    std::array<double, lanes> sums{};
    for (std::size_t i = 0; i + lanes <= modes; i += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        sums[lane] += touched[i + lane] * q[i + lane];
      }
    }
    double sum = sums[0] + sums[1] + sums[2] + sums[3];
    for (std::size_t i = modes - modes % lanes; i < modes; ++i) {
      sum += touched[i] * q[i];
    }
    benchmark::DoNotOptimize(sum);
    for (std::size_t i = 0; i < modes; ++i) {
      v[i] += 1e-6 * touched[i];
    }
    benchmark::ClobberMemory();
  }
};

void plain_loop(benchmark::State& state) {
  PlainModes plain;
  for (auto _ : state) {
    plain.tick();
  }
}
BENCHMARK(plain_loop);

// A tick of the modes and their displacement over a plain loop's.
void modal_core_per_plain_loop(benchmark::State& state) {
  const VibratingPlate plate{made_up_model(PlainModes::modes, 10)};
  ModalState modes{plate.model, Integrator::exact, dt_s};
  modes.touch(plate.locator->locate(0.1, 0.1), {0.0, 0.0, 1.0});
  PlainModes plain;
  compare(
      state,
      [&] {
        modes.tick();
        benchmark::DoNotOptimize(modes.displacement_m());
        modes.strike(1e-6);
      },
      [&] { plain.tick(); });
}
BENCHMARK(modal_core_per_plain_loop);
}  // namespace
BENCHMARK_MAIN();
