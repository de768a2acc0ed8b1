#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

// What kind of member a Visit method has handed over (core/visit.h lists them).
namespace contour::visit {

struct AnyVisitor {};

template <class T>
concept Struct = requires(T& t, AnyVisitor& v) {
  t.Visit(v);
};

template <class T>
concept NamedEnum = std::is_enum_v<T> && requires(T& t, std::string_view s) {
  { FromName(s, t) } -> std::convertible_to<bool>;
  { Name(t) } -> std::convertible_to<std::string_view>;
  { Choices(t) } -> std::convertible_to<std::string_view>;
};

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;

template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t N>
inline constexpr bool kIsArray<std::array<T, N>> = true;

template <class T>
inline constexpr bool kIsMap = false;
template <class T>
inline constexpr bool kIsMap<std::map<std::string, T>> = true;

template <class T>
concept Integer = std::integral<T> && !std::same_as<T, bool>;

template <class>
inline constexpr bool kUnsupported = false;

}  // namespace contour::visit
