#pragma once
namespace silt {
inline constexpr const char* version = "0.1.0";
}
