#pragma once
#include "protocols/procedures/procedure.hpp"
namespace tapstudy::protocols {
// Method of constant stimuli: listed values in random order.
const Procedure& constant_stimuli();
// Up-down staircases: transformed (Levitt 1971) and weighted (Kaernbach 1991).
const Procedure& staircase();
// QUEST+ (Watson 2017): the stimulus of least expected entropy of the parameters.
const Procedure& quest_plus();
// The psi method (Kontsevich & Tyler 1999): QUEST+ of one stimulus axis with guess and lapse rate
// fixed.
const Procedure& psi();
}  // namespace tapstudy::protocols
