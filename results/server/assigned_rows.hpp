#pragma once
#include <string>

#include "results/server/server_connection.hpp"
namespace tapstudy::results {
struct StudyOfServer {
  std::string title;
  std::string protocol_sha256;
};
// Which row of a study's balanced orders, from 1, a participant of a site has: the one that it was
// given before, or the next one that nobody of any site has been given or pushed as a real
// participant. Two sites never get the same one. Throws StoreError, also where the server knows
// another protocol of that title (rows of the two would be dealt twice) or another participant
// whose id differs in nothing but letter case.
int assigned_row(const StudyOfServer& study, const std::string& site,
                 const std::string& participant_id, ServerConnection& server);
}  // namespace tapstudy::results
