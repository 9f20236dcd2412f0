// Making the lists of neighbours anew: migration, sorting, ghosts, pairs, and when it is time for it.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/error.hpp"
#include "base/petsc.hpp"
#include "particles/engine.hpp"
#include "particles/log_event.hpp"

namespace silt {

void Engine::rebuild(Aligned<Load>& carried, bool within_step, double h) {
  static const PetscLogEvent event = log_event("SiltRebuild");
  const Logged logged(event);
  ++rebuilds_;
  if (within_step) adapt_skin();
  if (fluid_ && within_step) collect_fluid();  // between steps all is collected, and new ones have no drag yet
  std::string fast;
  // None did where the longest way of all in this step is below the least radius.
  if (within_step && strode_ > *std::min_element(smallest_.radius.begin(), smallest_.radius.end()))
    for (int p = 0; p < store.owned && fast.empty(); ++p)
      if (h * h * vec3(store.motion[p].velocity).squaredNorm() > store.motion[p].radius * store.motion[p].radius)
        fast = fmt::format("a particle moves more than its radius in a step of {:g} s (-particles_fast): {}", h,
                           describe(p));
  if (options_.fast == "stop")
    stop_if_any(fast);
  else
    report("warn", fast);

  few_loaded_ = few_loaded_before_ = false;  // the particles get other places
  const int contacts_before = contacts.contacts();
  if (migration_.any_away(store)) {
    if (!detached_) detach();
    memory_.complete(store.id);
    const std::vector<Gone> gone = migration_.run(store, carried, memory_.rows, wall_memory_);
    const long long gone_everywhere = mpi_sum(static_cast<long long>(gone.size()));
    if (gone_everywhere > 0) {
      depart(gone, within_step, h);
      liquid_.forget(store, memory_, gone, communicator_);
      removed += gone_everywhere;
      total -= gone_everywhere;
    }
  }
  const long long counted = mpi_sum(static_cast<long long>(store.owned));
  if (counted != total) throw RunError(fmt::format("{} particles are accounted for, but {} are there", total, counted));

  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
  for (int p = 0; p < store.owned; ++p) {
    const auto position = vec3(store.motion[p].position);
    lower = p == 0 ? Vec3(position) : lower.cwiseMin(position);
    upper = p == 0 ? Vec3(position) : upper.cwiseMax(position);
  }
  const double gap = laws_.setup().leave_gap;
  const double reach = 2 * largest_radius_ + gap + skin_;
  const CellGrid grid(lower, upper, mesh.lower, periods_, reach, store.owned);
  Bins own(sort_along(grid, carried), store, mpi_size() > 1);
  halo_.build(store, periods_, grid, own, reach, gap + skin_);
  store.reserve(store.all());
  store.place_padding();
  // A pair that has just passed the gap is looked at once more: it gives its liquid back, its force ends within the
  // step.
  const bool once_more = liquid_.active() || laws_.setup().jumping;
  contacts.clear();
  contacts.reserve(contacts_before + contacts_before / 32);
  find_pairs(grid, own, store, periods_, {laws_.setup().enter_gap, gap, skin_, once_more ? gap + skin_ : gap}, memory_,
             kernels_, contacts);
  travel_ = wall_travel_ = path_ = way_ = 0;
  if (!within_step) stride_ = infinity;  // who knows what has happened
  steps_since_rebuild_ = 0;
  contacts.pad(store.padding(), store.owned);
  wall_contacts.restore(wall_memory_);
  memory_.rows.release();
  wall_memory_.release();
  detached_ = false;
  walls_.list(store.motion.data(), store.owned, skin_, gap);
  store.note_origins(lower, upper);
  if (fluid_ && within_step) prepare_fluid(h);
  sum_up();
}

/// The order of the owned particles along the grid's cells. They, and what their contacts remember, are brought into
/// it where many stand behind one of a later cell (every other one of those at random places does): a few that are
/// met a little later cost less than moving all.
CellOrder Engine::sort_along(const CellGrid& grid, Aligned<Load>& carried) {
  CellOrder sorted = order_along(grid, store);
  const bool move = sorted.steps_back > store.owned / 4;
  std::vector<int>& order = sorted.order;
  if (detached_) {
    if (move) memory_.rows.reorder(order), wall_memory_.reorder(order);
  } else {
    std::vector<int> new_place(move ? order.size() : 0);
    for (std::size_t k = 0; k < new_place.size(); ++k) new_place[order[k]] = static_cast<int>(k);
    contacts.gather_once(store, new_place, memory_);
    wall_contacts.gather(store.owned, wall_memory_);
    if (move) wall_memory_.reorder(order);
  }
  store.ghosts = 0;
  store.id.resize(store.owned);
  if (move) {
    store.reorder(order, carried);
    std::iota(order.begin(), order.end(), 0);
  }
  return sorted;
}

void Engine::hear() {
  if (!news_.told()) return;
  const StepNews::Numbers& news = news_.hear();
  travel_ = news.farthest;
  wall_travel_ = news.walls;
  stride_ = news.stride;
  if (news.trouble > 0) stop_if_any(trouble_);
}

/// Far from where the lists end, what the ranks tell each other is heard in the next step, and meanwhile one may be
/// ahead of another by nearly a step: their steps differ by some percent, and in each they would wait for the slower
/// one. A particle would have to come a tenth of the skin further in a step than ever before for the lists to end
/// unnoticed.
bool Engine::agree_on_lists(double farthest) {
  const double come = std::max(travel_, wall_travel_), margin = std::max(0.1 * skin_, 2 * stride_);
  const bool each_for_itself = mpi_size() > 1 && fields_.empty() && !heat_ && !energy_ && !liquid_.active() &&
                               !brownian_.active() && come + margin < 0.5 * skin_;
  news_.tell({double(!trouble_.empty()), walls_.moved(), farthest, strode_}, !each_for_itself);
  if (each_for_itself) return false;
  hear();
  return wall_travel_ > 0.5 * skin_ || out_of_lists();
}

/// The bound on how far particles have come grows with the fastest of each step; before the lists are made anew, the
/// distances from where they were made are looked at.
bool Engine::out_of_lists() {
  if (travel_ <= 0.5 * skin_) return false;
  double largest = store.longest_way();
  if (mpi_size() > 1) MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  travel_ = std::min(travel_, largest);
  return travel_ > 0.45 * skin_;
}

/// Where particles run, a wider skin costs less than the lists it saves (candidates are tested only once they may
/// touch).
void Engine::adapt_skin() {
  constexpr int seldom = 60;
  if (options_.skin > 0 || steps_since_rebuild_ >= seldom) return;
  double widest = 0.5 * largest_radius_;
  for (const double length : periods_.length)
    if (length > 0) widest = std::min(widest, 0.5 * length - 2 * largest_radius_ - laws_.setup().leave_gap);
  skin_ = std::max(skin_, std::min(1.25 * skin_, widest));
}

}  // namespace silt
