#pragma once
#include <string>

#include "core/model/body_modes.hpp"
#include "core/model/modal_model.hpp"
namespace tapstudy::core {
// Writes the body with its mode shapes as a VTK unstructured grid (ParaView's .vtu, text): cells of
// 4 or 10 nodes; one vector per node and mode, mass-normalised [kg^-1/2], named mode_1 …; as field
// data the natural frequencies, frequency_hz, and the modal masses of the shapes scaled to a
// largest displacement of 1, modal_mass_kg. Why not VTK: its development package brings 200 others,
// for one text file of a format published whole (VTK File Formats, XML unstructured grid). meshio
// reads it back in the tests. Throws InvalidInput if the file exists already or cannot be written.
void write_vtu(const SolvedBody& body, const ModalModel& modal, double density_kg_per_m3,
               const std::string& file);
}  // namespace tapstudy::core
