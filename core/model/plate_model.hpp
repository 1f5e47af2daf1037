#pragma once
#include <string>
#include <vector>

#include "core/model/fixation.hpp"
#include "core/model/modal_model.hpp"
#include "core/model/tetgen_mesher.hpp"
namespace tapstudy::core {
struct PlateSpec {
  Box box;
  MeshSize mesh;
  std::vector<Fixation> fixations;
  Material material;
  double band_limit_hz{};  // > 0; modes above are left out
};

// Equal text for plates that have one and the same model.
std::string content_key(const PlateSpec& plate);

struct PlateModel {
  ModalModel modal;
  TetMesh mesh;
  ModelReport report;
};

// Mesh, matrices, modes, damping (paper sections 4.2.1 and 4.2.2).
// Throws InvalidInput for properties out of range, ModelError for what cannot be built.
PlateModel build_plate_model(const PlateSpec& plate);
}  // namespace tapstudy::core
