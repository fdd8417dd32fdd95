// A small importer of FMUs: reads the archive, opens the binary, and calls it as FMI 2.0 and 3.0 say.
#pragma once

#include <dlfcn.h>
#include <zip.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "codegen/backends/fmu/fmu.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::test {

/// The files of an archive by their names.
inline std::map<std::string, std::string> unpacked(const std::string& archive_bytes) {
  const ScratchFolder folder;
  const std::string path = folder.write("archive.zip", archive_bytes);
  zip_t* const archive = zip_open(path.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, nullptr);
  if (archive == nullptr) {
    throw std::runtime_error("no archive");
  }
  std::map<std::string, std::string> files;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
    zip_stat_t about;
    zip_stat_index(archive, static_cast<zip_uint64_t>(i), 0, &about);
    std::string text(about.size, '\0');
    zip_file_t* const file = zip_fopen_index(archive, static_cast<zip_uint64_t>(i), 0);
    zip_fread(file, text.data(), text.size());
    zip_fclose(file);
    files[about.name] = text;
  }
  zip_discard(archive);
  return files;
}

/// An FMU of either version, loaded. Variables are read and set as numbers, by their value references.
class LoadedFmu {
 public:
  explicit LoadedFmu(const std::string& archive_bytes) : files_(unpacked(archive_bytes)) {
    description_.load_string(files_.at("modelDescription.xml").c_str());
    three_ = std::string(root().attribute("fmiVersion").value()) == "3.0";
    token_ = root().attribute(three_ ? "instantiationToken" : "guid").value();
    const std::string name = root().child("CoSimulation").attribute("modelIdentifier").value();
    const std::string binary = "binaries/" + std::string(three_ ? "x86_64-linux/" : "linux64/") + name + ".so";
    handle_ = dlopen(folder_.write("model.so", files_.at(binary)).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ == nullptr) {
      throw std::runtime_error(dlerror());
    }
    for (const pugi::xml_node node : root().child("ModelVariables").children()) {
      references_[node.attribute("name").value()] = node.attribute("valueReference").as_uint();
      types_[node.attribute("valueReference").as_uint()] = three_ ? node.name() : node.first_child().name();
    }
  }
  ~LoadedFmu() { dlclose(handle_); }
  LoadedFmu(const LoadedFmu&) = delete;
  LoadedFmu& operator=(const LoadedFmu&) = delete;

  [[nodiscard]] pugi::xml_node root() const { return description_.child("fmiModelDescription"); }
  [[nodiscard]] bool three() const { return three_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] const std::map<std::string, std::string>& files() const { return files_; }
  [[nodiscard]] std::uint32_t reference(const std::string& name) const { return references_.at(name); }
  [[nodiscard]] const std::string& type(std::uint32_t reference) const { return types_.at(reference); }

  /// A function of the version by its name without fmi2 or fmi3.
  template <class Signature>
  [[nodiscard]] Signature* function(const std::string& name) const {
    void* const found = dlsym(handle_, ((three_ ? "fmi3" : "fmi2") + name).c_str());
    if (found == nullptr) {
      throw std::runtime_error("the binary has no " + name);
    }
    return reinterpret_cast<Signature*>(found);
  }

 private:
  ScratchFolder folder_;
  std::map<std::string, std::string> files_;
  pugi::xml_document description_;
  bool three_ = false;
  std::string token_;
  void* handle_ = nullptr;
  std::map<std::string, std::uint32_t> references_;
  std::map<std::uint32_t, std::string> types_;
};

/// An instance, from its beginning to its end. Each call gives the status of FMI: 0 for done, 2 discarded, 3 an error.
class FmuInstance {
 public:
  explicit FmuInstance(const LoadedFmu& fmu) : FmuInstance(fmu, fmu.token()) {}
  FmuInstance(const LoadedFmu& fmu, const std::string& token) : fmu_(fmu), callbacks_{} {
    component_ =
        fmu.three()
            ? fmu.function<void*(const char*, const char*, const char*, bool, bool, bool, bool, const std::uint32_t*,
                                 std::size_t, void*, void*, void*)>("InstantiateCoSimulation")(
                  "test", token.c_str(), nullptr, false, false, false, false, nullptr, 0, nullptr, nullptr, nullptr)
            : fmu.function<void*(const char*, int, const char*, const char*, const void*, int, int)>("Instantiate")(
                  "test", 1, token.c_str(), nullptr, &callbacks_, 0, 0);
  }
  ~FmuInstance() { fmu_.function<void(void*)>("FreeInstance")(component_); }
  FmuInstance(const FmuInstance&) = delete;
  FmuInstance& operator=(const FmuInstance&) = delete;

  [[nodiscard]] bool there() const { return component_ != nullptr; }
  [[nodiscard]] void* component() const { return component_; }
  int begin(double start = 0.0) {
    if (fmu_.three()) {
      return fmu_.function<int(void*, bool, double, double, bool, double)>("EnterInitializationMode")(
          component_, false, 0.0, start, false, 0.0);
    }
    const int status = fmu_.function<int(void*, int, double, double, int, double)>("SetupExperiment")(
        component_, 0, 0.0, start, 0, 0.0);
    return status != 0 ? status : call("EnterInitializationMode");
  }
  int go() { return call("ExitInitializationMode"); }
  int start(double time = 0.0) { return begin(time) + go(); }
  int call(const std::string& name) { return fmu_.function<int(void*)>(name)(component_); }

  int step(double time, double size) {
    if (!fmu_.three()) {
      return fmu_.function<int(void*, double, double, int)>("DoStep")(component_, time, size, 1);
    }
    bool event = true;
    bool terminate = true;
    bool early = true;
    double reached = 0.0;
    const int status = fmu_.function<int(void*, double, double, bool, bool*, bool*, bool*, double*)>("DoStep")(
        component_, time, size, true, &event, &terminate, &early, &reached);
    return event || terminate || early || (status == 0 && reached != time + size) ? -1 : status;
  }

  int set(std::uint32_t reference, double value) { return set_array(reference, {value}); }
  /// Of FMI 3.0: all elements by one call.
  int set_array(std::uint32_t reference, std::vector<double> values) { return access("Set", reference, values); }
  std::vector<double> get_array(std::uint32_t reference, std::size_t count) {
    std::vector<double> values(count);
    if (const int status = access("Get", reference, values); status != 0) {
      throw std::runtime_error("cannot be read");
    }
    return values;
  }
  int set(const std::string& name, double value) { return set(fmu_.reference(name), value); }
  double get(std::uint32_t reference) { return get_array(reference, 1).front(); }
  double get(const std::string& name) { return get(fmu_.reference(name)); }

  int save(void** state) { return fmu_.function<int(void*, void**)>(state_name("Get", ""))(component_, state); }
  int restore(void* state) { return fmu_.function<int(void*, void*)>(state_name("Set", ""))(component_, state); }
  int forget(void** state) { return fmu_.function<int(void*, void**)>(state_name("Free", ""))(component_, state); }
  std::vector<char> bytes_of(void* state) {
    std::size_t size = 0;
    fmu_.function<int(void*, void*, std::size_t*)>(state_name("Serialized", "Size"))(component_, state, &size);
    std::vector<char> bytes(size);
    fmu_.function<int(void*, void*, char*, std::size_t)>(state_name("Serialize", ""))(component_, state, bytes.data(),
                                                                                      size);
    return bytes;
  }
  int state_from(const std::vector<char>& bytes, void** state) {
    return fmu_.function<int(void*, const char*, std::size_t, void**)>(
        state_name(fmu_.three() ? "Deserialize" : "DeSerialize", ""))(component_, bytes.data(), bytes.size(), state);
  }

 private:
  [[nodiscard]] std::string state_name(const std::string& verb, const std::string& end) const {
    return verb + (fmu_.three() ? "FMUState" : "FMUstate") + end;
  }

  template <class Number>
  int access_as(const std::string& name, std::uint32_t reference, std::vector<double>& values) {
    const auto numbers = std::make_unique<Number[]>(values.size());
    std::transform(values.begin(), values.end(), numbers.get(), [](double one) { return static_cast<Number>(one); });
    const int status = fmu_.three()
                           ? fmu_.function<int(void*, const std::uint32_t*, std::size_t, Number*, std::size_t)>(name)(
                                 component_, &reference, 1, numbers.get(), values.size())
                           : fmu_.function<int(void*, const std::uint32_t*, std::size_t, Number*)>(name)(
                                 component_, &reference, 1, numbers.get());
    std::copy_n(numbers.get(), values.size(), values.begin());
    return status;
  }
  int access(const std::string& verb, std::uint32_t reference, std::vector<double>& values) {
    const std::string& type = fmu_.type(reference);
    if (type == "Float64" || type == "Real") {
      return access_as<double>(verb + type, reference, values);
    }
    if (type == "Float32") {
      return access_as<float>(verb + type, reference, values);
    }
    if (type == "UInt16") {
      return access_as<std::uint16_t>(verb + type, reference, values);
    }
    if (type == "Boolean" && fmu_.three()) {
      return access_as<bool>(verb + type, reference, values);
    }
    return access_as<std::int32_t>(verb + type, reference, values);
  }

  struct Callbacks {
    void* functions[5];
  };
  const LoadedFmu& fmu_;
  Callbacks callbacks_;
  void* component_ = nullptr;
};

}  // namespace hysteron::test
