#include "app/energy_table.hpp"

namespace silt {

EnergyTable::EnergyTable(const Particles* particles) {
  if (!particles || !particles->has_energy_account()) return;
  columns_ = {"time", "kinetic", "rotational", "stored"};
  for (const char* mechanism : Particles::EnergyAccount::names) columns_.push_back(mechanism);
  columns_.push_back("residual");
}

std::vector<std::string> EnergyTable::quantities() const {
  std::vector<std::string> names;
  for (std::size_t k = 1; k < columns_.size(); ++k) names.push_back("energy." + columns_[k]);
  return names;
}

void EnergyTable::start(const OutputDirectory& directory) {
  if (!columns_.empty()) table_ = directory.table("energy.csv", columns_);
}

void EnergyTable::sample(const Moment& moment, Quantities& quantities) {
  if (columns_.empty()) return;
  const auto account = moment.particles->energy_account();
  std::vector<double> row = {moment.time, account.kinetic, account.rotational, account.stored};
  row.insert(row.end(), account.work.begin(), account.work.end());
  row.push_back(account.residual());
  for (std::size_t k = 1; k < row.size(); ++k) quantities.set("energy." + columns_[k], row[k]);
  table_.row(row);
}

}  // namespace silt
