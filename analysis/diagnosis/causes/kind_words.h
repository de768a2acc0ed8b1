#pragma once

#include <string>
#include <string_view>

namespace contour::diagnosis {

/// A kind of cause in plain words: "cogging: a torque that repeats with the motor angle".
std::string KindWords(std::string_view kind);

/// What to do about it, as an engineer would say it.
std::string KindAdvice(std::string_view kind);

/// A parameter's value with its unit, taken from its name: {"amplitude_Nm", 0.0191} is "0.0191 Nm".
std::string ValueWords(std::string_view parameter, double value);

/// A parameter's name without its unit: "amplitude".
std::string ParameterWords(std::string_view parameter);

}  // namespace contour::diagnosis
