#pragma once
#include <petscsys.h>

namespace silt {

/// An event of `-log_view`, registered once (collective in the order of registration).
inline PetscLogEvent log_event(const char* name) {
  static const PetscClassId id = [] {
    PetscClassId made = 0;
    PetscClassIdRegister("Silt particles", &made);
    return made;
  }();
  PetscLogEvent event = 0;
  PetscLogEventRegister(name, id, &event);
  return event;
}

/// `-log_view` shows the time of its scope and what it sends: PETSc's headers count the messages of a file that
/// includes them.
class Logged {
 public:
  explicit Logged(PetscLogEvent event) : event_(event) {
    PetscLogEventBegin(event_, nullptr, nullptr, nullptr, nullptr);
  }
  ~Logged() { PetscLogEventEnd(event_, nullptr, nullptr, nullptr, nullptr); }
  Logged(const Logged&) = delete;
  Logged& operator=(const Logged&) = delete;

 private:
  PetscLogEvent event_;
};

}  // namespace silt
