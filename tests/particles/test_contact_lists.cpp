#include <catch2/catch.hpp>
#include <set>

#include "gas_box.hpp"
#include "particles/contact_lists.hpp"

using namespace silt;

namespace {

std::vector<double> gaps;   ///< of the pairs (n, n + 1), instead of those of positions
std::vector<int> measured;  ///< pairs looked at

void measure(CandidateSweep& sweep) {
  for (int k = 0; k < sweep.count; ++k) {
    measured.push_back(sweep.i[k]);
    sweep.gap[k] = gaps[sweep.i[k]];
  }
}

}  // namespace

TEST_CASE("Every candidate that may touch is tested, whatever pairs begin and end in between, and far ones are not") {
  Random random(3);
  ContactLists lists(1);
  constexpr double skin = 1e-3;
  constexpr int count = 1500, owned = 1300;  // the others are ghosts
  gaps.resize(count);
  std::set<int> touching;
  for (int n = 0; n < count; ++n) {
    gaps[n] = random(0, 1.2) * skin;
    lists.add_candidate(n, n + 1, gaps[n] / skin);
  }
  lists.pad(count + 2, owned);
  double moved = 0;
  long long looked_at = 0;
  for (int step = 0; step < 400; ++step) {
    const double way = random(0, 4e-3);  // a share of the skin; in all far beyond the half skin of a rebuild
    moved += way;
    for (double& gap : gaps) gap += random(-2, 2) * way * skin;  // no more than both particles together may come
    measured.clear();
    CandidateSweep sweep;
    lists.look(sweep, moved, skin, measure);
    looked_at += lists.looked_at();
    const std::set<int> tested(measured.begin(), measured.end());
    REQUIRE(tested.size() == measured.size());  // none twice
    for (int n = 0; n < count; ++n) {
      if (touching.count(n)) REQUIRE(tested.count(n) == 0);
      if (gaps[n] < 0) touching.insert(n);
    }
    // All that touch are there, so none was missed.
    std::set<int> there;
    for (int k = 0; k < lists.contacts(); ++k) there.insert(lists.contact_i()[k]);
    REQUIRE(there == touching);
    for (int k = 0; k < lists.contacts(); ++k) {  // each keeps its memory wherever it is moved to
      double& memory = lists.history(0, k);
      if (memory == 0) memory = lists.contact_i()[k] + 1;
      REQUIRE(memory == lists.contact_i()[k] + 1);
    }
    unsigned char* leaving = lists.leaving();
    int ended = 0;
    for (int k = 0; k < lists.contacts(); ++k)
      if (const int n = lists.contact_i()[k]; gaps[n] >= 0) {
        leaving[k / 8] |= static_cast<unsigned char>(1 << k % 8);
        ++ended;
        touching.erase(n);
      }
    lists.leave(ended);
    there.clear();
    for (int k = 0; k < lists.contacts(); ++k) there.insert(lists.contact_i()[k]);
    REQUIRE(there == touching);
    REQUIRE(lists.candidates() == count - static_cast<int>(touching.size()));
    // Those with a ghost stand first, in as few packs as hold them.
    int with_ghost = 0;
    for (int k = 0; k < lists.contacts(); ++k) with_ghost += lists.contact_j()[k] >= owned;
    REQUIRE(lists.first_inner() == (with_ghost + 7) / 8 * 8);
    for (int k = lists.first_inner(); k < lists.contacts(); ++k) REQUIRE(lists.contact_j()[k] < owned);
  }
  CHECK(looked_at < 0.2 * 400 * count);
}

TEST_CASE("A memory of each contact once, completed, is that of both partners, in any order of the particles") {
  Random random(5);
  Store store;
  store.owned = 40, store.ghosts = 10;
  store.reserve(50);
  for (int p = 0; p < 50; ++p) store.id.push_back((37 * p) % 101);
  ContactLists lists(2);
  for (int n = 0; n < 120; ++n) {
    const int a = n % 40, b = (a + 1 + n / 40 * 7) % 50;
    const double history[2] = {random(-1, 1), random(-1, 1)};
    const bool first = store.id[a] < store.id[b];
    lists.add_contact(first ? a : b, first ? b : a, history, 1);
  }
  std::vector<int> new_place(40);
  for (int p = 0; p < 40; ++p) new_place[p] = (11 * p + 3) % 40;
  std::vector<std::int64_t> new_id(40);
  for (int p = 0; p < 40; ++p) new_id[new_place[p]] = store.id[p];
  ContactMemory both(2), once(2);
  lists.gather(store, both);
  lists.gather_once(store, new_place, once);
  CHECK(once.rows.entries.size() < both.rows.entries.size());
  once.complete(new_id);
  REQUIRE(once.rows.entries.size() == both.rows.entries.size());
  for (int p = 0; p < 40; ++p) {
    REQUIRE(once.rows.rows(new_place[p]) == both.rows.rows(p));
    for (int k = both.rows.start[p]; k < both.rows.start[p + 1]; ++k) {
      const double* found = once.find(new_place[p], std::bit_cast<std::int64_t>(both.rows.row(k)[0]));
      REQUIRE(found != nullptr);
      CHECK(found[0] == both.rows.row(k)[1]);
      CHECK(found[1] == both.rows.row(k)[2]);
    }
  }
}
