#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/model/progress.hpp"
#include "results/server/server_connection.hpp"
namespace tapstudy::results {
// A study of the same title on the server whose protocol has another text.
struct StudyOfOtherText {
  std::string title;
  std::string protocol_sha256;
  std::string site;
};
struct Pushed {
  std::int64_t rows{};      // that the server has now and had not
  std::int64_t all_rows{};  // of the store
  std::optional<StudyOfOtherText> other_text;
};
// Adds to the server what the store in the directory holds and the server lacks, under the name of
// a site. What others see there is of the end of a push: one that was cut off shows nothing, and
// the next one goes on where it ended. A session that runs meanwhile does not wait. count: rows
// looked at. Throws StoreError, also where the server holds rows of that site's study that the
// store has not, or has otherwise: two directories under one name, or a backup that was put back;
// where another store of the study has a session or a participant's id of this one, so that no
// report could take both; where another push of the same store is under way; and where the server
// is of another version.
Pushed push_store(const std::string& directory, const std::string& site, ServerConnection& server,
                  const core::CountHook& count);
}  // namespace tapstudy::results
