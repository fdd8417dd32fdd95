#include <array>

#include "tool/fmu_worker/model.hpp"

namespace hysteron::fmu_worker {
namespace {

using cosimulation::Access;
using cosimulation::access_count;
using cosimulation::ChannelHead;

void log(void* environment, int status, const char* /*category*/, const char* message) {
  keep_message(*static_cast<ChannelHead*>(environment), status, message != nullptr ? message : "");
}

/// By Access.
constexpr std::array<const char*, access_count> names{"Float64", "Float32", "Int8",  "UInt8",  "Int16",
                                                      "UInt16",  "Int32",   "Int64", "Boolean"};

using Accessor = int(void*, const std::uint32_t*, std::size_t, void*, std::size_t);

class Fmi3 final : public Instance {
 public:
  Fmi3(const Library& library, ChannelHead& head, std::size_t lane)
      : library_(library),
        free_(library.function<void(void*)>("fmi3FreeInstance")),
        enter_(library.function<int(void*, bool, double, double, bool, double)>("fmi3EnterInitializationMode")),
        exit_(library.function<int(void*)>("fmi3ExitInitializationMode")),
        step_(library.function<int(void*, double, double, bool, bool*, bool*, bool*, double*)>("fmi3DoStep")) {
    const auto instantiate =
        library.function<void*(const char*, const char*, const char*, bool, bool, bool, bool, const std::uint32_t*,
                               std::size_t, void*, void (*)(void*, int, const char*, const char*), void*)>(
            "fmi3InstantiateCoSimulation");
    const std::string name = "hysteron_" + std::to_string(lane);
    const std::string resources = std::string(head.resources) + "/";
    instance_ = instantiate(name.c_str(), head.token, resources.c_str(), false, false, false, false, nullptr, 0, &head,
                            log, nullptr);
    if (instance_ == nullptr) {
      throw Refused("fmi3InstantiateCoSimulation gives no instance");
    }
  }
  ~Fmi3() override { free_(instance_); }

  void enter_initialization() override {
    require(enter_(instance_, false, 0.0, 0.0, false, 0.0), "fmi3EnterInitializationMode");
  }
  void exit_initialization() override { require(exit_(instance_), "fmi3ExitInitializationMode"); }
  void set(const Row& row) override { access(setters_, "fmi3Set", row); }
  void get(const Row& row) override { access(getters_, "fmi3Get", row); }
  void step(double time, double size) override {
    bool event = false;
    bool terminate = false;
    bool early = false;
    double reached = time + size;
    require(step_(instance_, time, size, true, &event, &terminate, &early, &reached), "fmi3DoStep");
    if (terminate) {
      throw Refused("the model ends its simulation here (terminateSimulation)");
    }
    if (early) {
      throw Refused("fmi3DoStep returned early, though that was not allowed");
    }
  }

 private:
  void access(std::array<Accessor*, access_count>& known, const char* verb, const Row& row) {
    const auto place = static_cast<std::size_t>(row.access);
    const auto name = [&] { return std::string(verb) + names[place]; };
    if (known[place] == nullptr) {
      known[place] = library_.function<Accessor>(name());
    }
    if (const int status = known[place](instance_, row.references, row.count, row.numbers, row.elements); status > 1) {
      require(status, name().c_str());
    }
  }

  const Library& library_;
  void* instance_ = nullptr;
  void (*free_)(void*);
  int (*enter_)(void*, bool, double, double, bool, double);
  int (*exit_)(void*);
  int (*step_)(void*, double, double, bool, bool*, bool*, bool*, double*);
  std::array<Accessor*, access_count> setters_{};
  std::array<Accessor*, access_count> getters_{};
};

}  // namespace

std::unique_ptr<Instance> new_fmi3(const Library& library, ChannelHead& head, std::size_t lane) {
  return std::make_unique<Fmi3>(library, head, lane);
}

}  // namespace hysteron::fmu_worker
