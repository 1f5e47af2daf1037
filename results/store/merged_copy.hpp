#pragma once
#include <string>
#include <vector>
namespace tapstudy::results {
// Writes the study whose participants are divided among these directories into another one, without
// a study so far: every row of each as it is, but for the ids of sessions, trials, answers and
// actions, which are as of one program that ran one session after the other, in this order. The
// journal is written anew. That they are of one study, and none of them twice, is for the caller to
// know. Throws StoreError and InvalidInput as Store::open_existing, and StoreError if two hold the
// same participant or schemas differ.
void write_merged_copy(const std::vector<std::string>& directories, const std::string& copy);
}  // namespace tapstudy::results
