#pragma once
#include <Eigen/Core>

#include "analysis/modal/response/response_modes.hpp"
namespace tapstudy::analysis {
// The shape of a mode: the vector that with one of the inputs explains most of its residues, which
// are the product of the displacements of the two places. As ResponseMode::shape.
Eigen::VectorXcd shape_of(const Eigen::VectorXcd& residues, const ResponseGrid& grid);

// As ResponseMode::phase_collinearity; 1 for a single place.
double phase_collinearity(const Eigen::VectorXcd& shape);

// Where force and motion are of one place and direction, each mode's residue is the square of its
// displacement there over 2 j times its damped frequency: all imaginary parts are negative. Remarks
// on driving points where all are positive, or where those of some modes, by more than three
// standard errors and larger than their real parts, have another sign than those of most.
void add_driving_point_remarks(const ResidueFit& fit, ResponseModes& found);
}  // namespace tapstudy::analysis
