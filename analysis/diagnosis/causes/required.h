#pragma once

#include <concepts>
#include <type_traits>
#include <utility>

namespace contour::diagnosis {

/// A member that has no value of its own: leaving it out does not compile. A bool takes a bool and nothing
/// that only converts to one.
template <class T>
class Required {
 public:
  Required() = delete;
  template <class U>
  requires std::convertible_to<U, T> &&
      (!std::same_as<T, bool> || std::same_as<std::remove_cvref_t<U>, bool> ||
       std::same_as<std::remove_cvref_t<U>, Required<bool>>)constexpr Required(U&& value)
      : value_(std::forward<U>(value)) {}

  constexpr operator const T&() const { return value_; }
  constexpr const T& operator*() const { return value_; }
  constexpr const T& operator->() const requires std::is_pointer_v<T> { return value_; }

 private:
  T value_;
};

}  // namespace contour::diagnosis
