#pragma once
#include <string>

#include "core/model/body_modes.hpp"
#include "core/model/modal_model.hpp"
namespace tapstudy::core {
// Writes the body with its mode shapes as a universal file (SDRC's, text; the University of
// Cincinnati documents it), which programs of modal analysis read. Data sets: 164, units of the SI;
// 15 and 2411, the nodes in single and in double precision, labelled from 1; 2412, tetrahedra of 4
// nodes (solid linear, 111) or 10 (solid parabolic, 118); 55, one a mode: its number, frequency
// [Hz], modal mass 1, damping ratio, and the displacement of each node, real and mass-normalised
// [kg^-1/2]. Throws InvalidInput if the file exists already or cannot be written.
void write_universal_file(const SolvedBody& body, const ModalModel& modal, double density_kg_per_m3,
                          const std::string& file);
}  // namespace tapstudy::core
