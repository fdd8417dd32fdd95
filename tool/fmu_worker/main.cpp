// The process in which the binary of an FMU runs: whatever it does, it does here. It is started by the tool alone, with
// the shared memory and a pipe that ends with the tool.
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <thread>
#include <vector>

#include "tool/fmu_worker/model.hpp"

namespace hysteron::fmu_worker {
namespace {

using namespace cosimulation;

/// The numbers of one access, as FMI has them, beside their places among the doubles of the channel.
class AccessRow {
 public:
  AccessRow(std::uint32_t version, Access access) : version_(version), access_(access) {}

  void add(const ChannelVariable& variable, std::size_t place) {
    if (!variable.goes_on) {
      references_.push_back(variable.reference);
    }
    places_.push_back(place);
    numbers_.resize(places_.size());
  }
  [[nodiscard]] bool empty() const { return references_.empty(); }

  void set(Instance& instance, const double* values) {
    visit([&]<class Number>(Number* numbers) {
      for (std::size_t i = 0; i < places_.size(); ++i) {
        numbers[i] = static_cast<Number>(values[places_[i]]);
      }
    });
    instance.set(row());
  }
  void get(Instance& instance, double* values) {
    instance.get(row());
    visit([&]<class Number>(const Number* numbers) {
      for (std::size_t i = 0; i < places_.size(); ++i) {
        values[places_[i]] = static_cast<double>(numbers[i]);
      }
    });
  }

 private:
  [[nodiscard]] Row row() {
    return {.access = access_,
            .references = references_.data(),
            .count = references_.size(),
            .numbers = numbers_.data(),
            .elements = numbers_.size()};
  }
  template <class Visit>
  void visit(const Visit& visit) {
    void* const at = numbers_.data();
    switch (access_) {
      case Access::Float64:
        return visit(static_cast<double*>(at));
      case Access::Float32:
        return visit(static_cast<float*>(at));
      case Access::Int8:
        return visit(static_cast<std::int8_t*>(at));
      case Access::UInt8:
        return visit(static_cast<std::uint8_t*>(at));
      case Access::Int16:
        return visit(static_cast<std::int16_t*>(at));
      case Access::UInt16:
        return visit(static_cast<std::uint16_t*>(at));
      case Access::Int32:
        return visit(static_cast<std::int32_t*>(at));
      case Access::Int64:
        return visit(static_cast<std::int64_t*>(at));
      case Access::Boolean:
        return version_ == 2 ? visit(static_cast<int*>(at)) : visit(static_cast<bool*>(at));
    }
  }

  std::uint32_t version_;
  Access access_;
  std::vector<std::uint32_t> references_;
  std::vector<std::size_t> places_;
  std::vector<double> numbers_;  ///< room for as many of the largest type
};

/// The variables of one causality, by access.
class Group {
 public:
  Group(std::uint32_t version, const ChannelVariable* variables, std::size_t count) {
    for (std::size_t access = 0; access < access_count; ++access) {
      AccessRow row(version, static_cast<Access>(access));
      for (std::size_t i = 0; i < count; ++i) {
        if (variables[i].access == static_cast<Access>(access)) {
          row.add(variables[i], i);
        }
      }
      if (!row.empty()) {
        rows_.push_back(std::move(row));
      }
    }
  }
  void set(Instance& instance, const double* values) {
    for (AccessRow& row : rows_) {
      row.set(instance, values);
    }
  }
  void get(Instance& instance, double* values) {
    for (AccessRow& row : rows_) {
      row.get(instance, values);
    }
  }

 private:
  std::vector<AccessRow> rows_;
};

class Worker {
 public:
  explicit Worker(ChannelView view)
      : view_(view),
        head_(view.head()),
        inputs_(head_.version, view.variables(), head_.inputs),
        parameters_(head_.version, view.variables() + head_.inputs, head_.parameters),
        outputs_(head_.version, view.variables() + head_.inputs + head_.parameters, head_.outputs) {}

  void serve(Patience patience) {
    while (true) {
      while (!wait_for_turn(head_.turn, Turn::Caller, std::chrono::hours(1), patience)) {
      }
      try {
        head_.command == Command::Begin ? begin() : step();
      } catch (const std::exception& problem) {
        refuse(problem.what());
      } catch (...) {
        refuse("it threw an exception of C++");
      }
      give_turn(head_.turn, Turn::Caller);
    }
  }

 private:
  void refuse(const char* text) {
    head_.refused = 1;
    std::snprintf(head_.message, sizeof(head_.message), "%s", text);
  }

  void begin() {
    instances_.clear();
    if (!library_) {
      library_ = std::make_unique<Library>(head_.library);
    }
    steps_ = 0;
    for (std::size_t lane = 0; lane < head_.lanes; ++lane) {
      instances_.push_back(head_.version == 2 ? new_fmi2(*library_, head_, lane) : new_fmi3(*library_, head_, lane));
      Instance& instance = *instances_.back();
      parameters_.set(instance, view_.parameters(lane));
      inputs_.set(instance, view_.inputs(lane));
      instance.enter_initialization();
      instance.exit_initialization();
      outputs_.get(instance, view_.outputs(lane));
    }
  }

  void step() {
    const double time = static_cast<double>(steps_) * head_.step;
    for (std::size_t lane = 0; lane < instances_.size(); ++lane) {
      Instance& instance = *instances_[lane];
      inputs_.set(instance, view_.inputs(lane));
      instance.step(time, head_.step);
      outputs_.get(instance, view_.outputs(lane));
    }
    ++steps_;
  }

  ChannelView view_;
  ChannelHead& head_;
  Group inputs_;
  Group parameters_;
  Group outputs_;
  std::unique_ptr<Library> library_{};
  std::vector<std::unique_ptr<Instance>> instances_{};
  std::uint64_t steps_ = 0;
};

int run() {
  struct stat about {};
  if (fstat(memory_descriptor, &about) != 0) {
    std::fputs("This program is started by hysteron, where a diagram has an FMU.\n", stderr);
    return 2;
  }
  void* const memory =
      mmap(nullptr, static_cast<std::size_t>(about.st_size), PROT_READ | PROT_WRITE, MAP_SHARED, memory_descriptor, 0);
  if (memory == MAP_FAILED) {
    return 2;
  }
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const ChannelView view(memory);
  // The folder of the FMU's own files: one that opens a file by a plain name finds it there, and leaves none elsewhere.
  if (chdir(view.head().resources) != 0) {
    return 2;
  }
  std::thread([unpacked = std::filesystem::path(view.head().resources).parent_path()] {
    char byte = 0;
    while (read(lifeline_descriptor, &byte, 1) > 0) {
    }
    std::error_code ignored;  // the tool is gone, also while the FMU works, and can no longer tidy up
    std::filesystem::remove_all(unpacked, ignored);
    _exit(0);
  }).detach();
  Worker(view).serve(Patience(std::thread::hardware_concurrency() > 1));
  return 0;
}

}  // namespace

void keep_message(ChannelHead& head, int status, const char* text) {
  if (status <= 0) {
    return;  // what went well
  }
  const std::size_t used = strnlen(head.log, sizeof(head.log));
  std::snprintf(head.log + used, sizeof(head.log) - used, "%s%s", used > 0 ? "; " : "", text);
}

void require(int status, const char* function) {
  constexpr const char* words[] = {"", "", "discards it", "returned an error", "returned a fatal error", "is pending"};
  if (status > 1 || status < 0) {
    throw Refused(std::string(function) + " " +
                  (status > 0 && status < 6 ? words[status] : "returned no status of FMI"));
  }
}

Library::Library(const char* path) : handle_(dlopen(path, RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) {
    throw Refused(std::string("its binary cannot be opened: ") + dlerror());
  }
}

void* Library::find(const std::string& name) const {
  void* const found = dlsym(handle_, name.c_str());
  if (found == nullptr) {
    throw Refused("its binary has no function " + name);
  }
  return found;
}

}  // namespace hysteron::fmu_worker

int main() {
  return hysteron::fmu_worker::run();
}
