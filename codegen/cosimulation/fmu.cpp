#include "codegen/cosimulation/fmu.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

#include "codegen/cosimulation/archive.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/sha256.hpp"
#include "support/text_file.hpp"

namespace hysteron::cosimulation {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_description = std::uint64_t{256} << 20U;  // bytes
constexpr double usual_time_limit = 30.0;                                 // s: the initialisation of a large model

#if defined(__x86_64__)
constexpr std::string_view folder_of_fmi2 = "linux64";
constexpr std::string_view folder_of_fmi3 = "x86_64-linux";
#elif defined(__aarch64__)
constexpr std::string_view folder_of_fmi2 = "aarch64-linux";
constexpr std::string_view folder_of_fmi3 = "aarch64-linux";
#else
constexpr std::string_view folder_of_fmi2 = "linux32";
constexpr std::string_view folder_of_fmi3 = "x86-linux";
#endif

std::atomic<double> limit{usual_time_limit};

std::mutex worker_lock;

/// Begun where it is first asked for: what sets it may be initialised before this file is.
fs::path& given_worker() {
  static fs::path given;
  return given;
}

}  // namespace

void set_time_limit(double seconds) {
  limit = seconds;
}
double time_limit() {
  return limit;
}

void set_worker_program(fs::path program) {
  const std::lock_guard lock(worker_lock);
  given_worker() = std::move(program);
}

fs::path worker_program() {
  constexpr std::string_view name = "hysteron-fmu-worker";
  {
    const std::lock_guard lock(worker_lock);
    if (!given_worker().empty()) {
      return given_worker();
    }
  }
  std::error_code unknown;
  const fs::path here = fs::read_symlink("/proc/self/exe", unknown).parent_path();
  const fs::path beside = here / name;
  return fs::exists(beside, unknown) ? beside : here.parent_path() / "libexec" / "hysteron" / name;
}

const Fmu& Fmu::open(const std::string& path) {
  using Key = std::tuple<std::string, fs::file_time_type, std::uintmax_t>;
  static std::mutex lock;
  static std::map<Key, std::unique_ptr<Fmu>> known;
  std::error_code unknown;
  const Key key{fs::weakly_canonical(path, unknown).string(), fs::last_write_time(path, unknown),
                fs::file_size(path, unknown)};
  const std::lock_guard guard(lock);
  auto& found = known[key];
  if (!found) {
    try {
      found = std::make_unique<Fmu>(path);
    } catch (...) {
      known.erase(key);
      throw;
    }
  }
  return *found;
}

Fmu::Fmu(const std::string& path) : path_(path) {
  std::error_code unknown;
  if (!fs::is_regular_file(path, unknown)) {
    throw InputError(error::unusable_fmu, {.file = path}, fmt::format("There is no file {}.", path),
                     "write the way to the FMU as seen from the folder of the diagram.");
  }
  try {
    const Archive archive(path);
    description_ = parse_description(archive.read("modelDescription.xml", largest_description));
  } catch (const std::runtime_error& problem) {
    refuse(problem.what());
  }
  hash_ = sha256(read_text_file(path));
}

void Fmu::refuse(const std::string& reason) const {
  throw InputError(error::unusable_fmu, {.file = path_}, fmt::format("{} cannot be used: {}.", path_, reason),
                   "export the model anew, as an FMU for co-simulation of FMI 2.0 or 3.0.");
}

void Fmu::refuse_without_binary(const Archive& archive, const std::string& wanted) const {
  std::set<std::string> platforms;
  for (const auto& [name, place] : archive.entries()) {
    constexpr std::string_view folder = "binaries/";
    if (name.starts_with(folder) && name.find('/', folder.size()) != std::string::npos) {
      platforms.insert(name.substr(folder.size(), name.find('/', folder.size()) - folder.size()));
    }
  }
  const std::string has =
      platforms.empty() ? "it has none at all" : fmt::format("it has those of {}", fmt::join(platforms, ", "));
  std::string mend = "export the model anew for this machine.";
  if (archive.has_folder("sources/")) {
    const std::string folder = wanted.substr(0, wanted.rfind('/'));
    mend = fmt::format(
        "compile its sources: unzip it into an empty folder, and there `mkdir -p {0} && cc -shared -fPIC -O2 -Isources "
        "-o {1} sources/*.c -lm`, then `zip -r` the folder again. Its documentation may name further sources or "
        "definitions.",
        folder, wanted);
  }
  throw InputError(error::fmu_does_not_start, {.file = path_},
                   fmt::format("{} has no binary {}: {}.", path_, wanted, has), std::move(mend));
}

const Fmu::Files& Fmu::files() const {
  const std::lock_guard lock(unpacking_);
  if (files_) {
    return *files_;
  }
  const std::string folder = fmt::format("binaries/{}/", description_.version == 2 ? folder_of_fmi2 : folder_of_fmi3);
  const std::string library = folder + description_.model_identifier + ".so";
  try {
    const Archive archive(path_);
    if (!archive.has(library)) {
      refuse_without_binary(archive, library);
    }
    folder_.emplace(fs::temp_directory_path());
    archive.unpack(folder, folder_->path());
    archive.unpack("resources/", folder_->path());
    fs::create_directories(folder_->path() / "resources");
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& problem) {
    refuse(problem.what());
  }
  files_ =
      Files{.library = (folder_->path() / library).string(), .resources = (folder_->path() / "resources").string()};
  return *files_;
}

}  // namespace hysteron::cosimulation
