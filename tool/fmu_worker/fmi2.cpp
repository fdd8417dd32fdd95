#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "tool/fmu_worker/model.hpp"

namespace hysteron::fmu_worker {
namespace {

using cosimulation::Access;
using cosimulation::ChannelHead;

/// fmi2CallbackFunctions.
struct Callbacks {
  void (*logger)(void* environment, const char* instance, int status, const char* category, const char* message, ...);
  void* (*allocate)(std::size_t count, std::size_t size);
  void (*release)(void* memory);
  void (*step_finished)(void* environment, int status);
  void* environment;
};

void log(void* environment, const char* /*instance*/, int status, const char* /*category*/, const char* message, ...) {
  std::array<char, 1024> text{};
  va_list arguments;
  va_start(arguments, message);
  std::vsnprintf(text.data(), text.size(), message != nullptr ? message : "", arguments);
  va_end(arguments);
  keep_message(*static_cast<ChannelHead*>(environment), status, text.data());
}

/// A path as a URI: what is no plain character is written by its number.
std::string uri_of(const char* path) {
  std::string uri = "file://";
  for (const char* c = path; *c != '\0'; ++c) {
    const bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9') || *c == '/' ||
                       *c == '-' || *c == '_' || *c == '.' || *c == '~';
    std::array<char, 4> number{};
    std::snprintf(number.data(), number.size(), "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(*c)));
    uri += plain ? std::string(1, *c) : std::string(number.data());
  }
  return uri;
}

class Fmi2 final : public Instance {
 public:
  Fmi2(const Library& library, ChannelHead& head, std::size_t lane)
      : callbacks_{log, std::calloc, std::free, nullptr, &head},
        free_(library.function<void(void*)>("fmi2FreeInstance")),
        enter_(library.function<int(void*)>("fmi2EnterInitializationMode")),
        exit_(library.function<int(void*)>("fmi2ExitInitializationMode")),
        setup_(library.function<int(void*, int, double, double, int, double)>("fmi2SetupExperiment")),
        step_(library.function<int(void*, double, double, int)>("fmi2DoStep")),
        set_real_(library.function<int(void*, const std::uint32_t*, std::size_t, const double*)>("fmi2SetReal")),
        get_real_(library.function<int(void*, const std::uint32_t*, std::size_t, double*)>("fmi2GetReal")),
        set_integer_(library.function<int(void*, const std::uint32_t*, std::size_t, const int*)>("fmi2SetInteger")),
        get_integer_(library.function<int(void*, const std::uint32_t*, std::size_t, int*)>("fmi2GetInteger")),
        set_boolean_(library.function<int(void*, const std::uint32_t*, std::size_t, const int*)>("fmi2SetBoolean")),
        get_boolean_(library.function<int(void*, const std::uint32_t*, std::size_t, int*)>("fmi2GetBoolean")) {
    constexpr int co_simulation = 1;
    const auto instantiate =
        library.function<void*(const char*, int, const char*, const char*, const Callbacks*, int, int)>(
            "fmi2Instantiate");
    const std::string name = "hysteron_" + std::to_string(lane);
    component_ =
        instantiate(name.c_str(), co_simulation, head.token, uri_of(head.resources).c_str(), &callbacks_, 0, 0);
    if (component_ == nullptr) {
      throw Refused("fmi2Instantiate gives no instance");
    }
  }
  ~Fmi2() override { free_(component_); }

  void enter_initialization() override {
    require(setup_(component_, 0, 0.0, 0.0, 0, 0.0), "fmi2SetupExperiment");
    require(enter_(component_), "fmi2EnterInitializationMode");
  }
  void exit_initialization() override { require(exit_(component_), "fmi2ExitInitializationMode"); }

  void set(const Row& row) override {
    switch (row.access) {
      case Access::Float64:
        require(set_real_(component_, row.references, row.count, static_cast<double*>(row.numbers)), "fmi2SetReal");
        break;
      case Access::Boolean:
        require(set_boolean_(component_, row.references, row.count, static_cast<int*>(row.numbers)), "fmi2SetBoolean");
        break;
      default:
        require(set_integer_(component_, row.references, row.count, static_cast<int*>(row.numbers)), "fmi2SetInteger");
        break;
    }
  }
  void get(const Row& row) override {
    switch (row.access) {
      case Access::Float64:
        require(get_real_(component_, row.references, row.count, static_cast<double*>(row.numbers)), "fmi2GetReal");
        break;
      case Access::Boolean:
        require(get_boolean_(component_, row.references, row.count, static_cast<int*>(row.numbers)), "fmi2GetBoolean");
        break;
      default:
        require(get_integer_(component_, row.references, row.count, static_cast<int*>(row.numbers)), "fmi2GetInteger");
        break;
    }
  }
  void step(double time, double size) override { require(step_(component_, time, size, 1), "fmi2DoStep"); }

 private:
  Callbacks callbacks_;
  void* component_ = nullptr;
  void (*free_)(void*);
  int (*enter_)(void*);
  int (*exit_)(void*);
  int (*setup_)(void*, int, double, double, int, double);
  int (*step_)(void*, double, double, int);
  int (*set_real_)(void*, const std::uint32_t*, std::size_t, const double*);
  int (*get_real_)(void*, const std::uint32_t*, std::size_t, double*);
  int (*set_integer_)(void*, const std::uint32_t*, std::size_t, const int*);
  int (*get_integer_)(void*, const std::uint32_t*, std::size_t, int*);
  int (*set_boolean_)(void*, const std::uint32_t*, std::size_t, const int*);
  int (*get_boolean_)(void*, const std::uint32_t*, std::size_t, int*);
};

}  // namespace

std::unique_ptr<Instance> new_fmi2(const Library& library, ChannelHead& head, std::size_t lane) {
  return std::make_unique<Fmi2>(library, head, lane);
}

}  // namespace hysteron::fmu_worker
