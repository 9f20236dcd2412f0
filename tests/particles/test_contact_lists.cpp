#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "gas_box.hpp"
#include "particles/contact_lists.hpp"

using namespace silt;

namespace {

std::set<std::pair<int, int>> tested(ContactLists& lists, double moved) {
  CandidateSweep sweep;
  lists.fill(sweep, moved);
  std::set<std::pair<int, int>> pairs;
  for (int k = 0; k < sweep.count; ++k) pairs.insert({sweep.i[k], sweep.j[k]});
  CHECK(static_cast<int>(pairs.size()) == sweep.count);  // none twice
  return pairs;
}

}  // namespace

TEST_CASE("Every candidate that may touch is tested, whatever pairs begin and end in between, and far ones are not") {
  Random random(3);
  ContactLists lists(0);
  std::map<std::pair<int, int>, double> gap;  // share of the skin when listed; 0: may touch at once
  lists.clear();
  for (int n = 0; n < 500; ++n) {
    const double share = random(-0.1, 1.2);
    lists.add_candidate(n, n + 1, share);
    gap[{n, n + 1}] = share;
  }
  lists.sort_candidates();
  constexpr int dummy = 1000;
  lists.pad(dummy);
  for (int round = 0; round < 40; ++round) {
    const double moved = round / 80.0;
    const auto pairs = tested(lists, moved);
    int needless = 0;
    for (const auto& [pair, share] : gap) {
      if (share <= 2 * moved) CHECK(pairs.count(pair) == 1);
      needless += share > 2 * moved + 1.01 / ContactLists::groups && pairs.count(pair) == 1;
    }
    CHECK((needless == 0 || 2 * moved > 1 - 1.0 / ContactLists::groups));
    // Some of those tested begin a contact, some contacts end and may begin anew at once.
    CandidateSweep sweep;
    lists.fill(sweep, moved);
    int places[8], count = 0;
    for (int k = 0; k < sweep.count && count < 8; k += 1 + sweep.count / 8) places[count++] = k;
    for (int e = 0; e < count; ++e) gap.erase({sweep.i[places[e]], sweep.j[places[e]]});
    lists.enter(places, count, dummy);
    int ending[3], ended = 0;
    for (int k = 0; k < lists.contacts() && ended < 3; k += 3) ending[ended++] = k;
    for (int e = 0; e < ended; ++e) gap[{lists.contact_i()[ending[e]], lists.contact_j()[ending[e]]}] = 0;
    lists.leave(ending, ended, dummy);
    CHECK(lists.candidates() == static_cast<int>(gap.size()));
  }
}
