// Errors as values. Nothing in the API throws; what can fail through its input or its environment returns a Result.
#pragma once
#include <cassert>
#include <cstdint>
#include <new>
#include <string>
#include <utility>
#include <variant>

namespace umbrage {

enum class ErrorCode : uint8_t {
  invalid_argument,     ///< The message names the argument and what it must be.
  stale_id,             ///< An id that was removed or never handed out.
  unsupported,          ///< The device lacks a feature or limit; the message names both.
  out_of_memory,        ///< Host or device memory.
  device_lost,          ///< VK_ERROR_DEVICE_LOST; the system can only be destroyed.
  vulkan,               ///< Any other failing Vulkan call; the message names call and result.
};

struct Error {
  ErrorCode code = ErrorCode::invalid_argument;
  std::string message;  ///< One line: what went wrong, where, and what to do where that is known.
};

/// Either a value or an Error. Precondition of value(): ok(); of error(): !ok().
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}
  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& value() & { assert(ok()); return *std::get_if<0>(&state_); }
  const T& value() const& { assert(ok()); return *std::get_if<0>(&state_); }
  T&& value() && { assert(ok()); return std::move(*std::get_if<0>(&state_)); }
  const Error& error() const { assert(!ok()); return *std::get_if<1>(&state_); }
  T& operator*() & { return value(); }
  T* operator->() { return &value(); }
  const T& operator*() const& { return value(); }
  const T* operator->() const { return &value(); }

 private:
  std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), ok_(false) {}
  bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }
  const Error& error() const { assert(!ok_); return error_; }

 private:
  Error error_;
  bool ok_ = true;
};

}  // namespace umbrage
