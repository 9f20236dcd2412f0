#include <fmt/format.h>

#include "app/version.hpp"

int main() { fmt::print("silt {}\n", silt::version); }
