// How `hysteron online-change` speaks with a task that runs: a socket in the file system, which no network reaches.
//
// Its owner alone may open it (mode 0600), and each side asks the kernel who the other is: a request counts only from
// the user of the task, and an answer only from a task of one's own user. A request is a line of JSON, and so is the
// answer; before it there may be lines that tell what is being done: {"progress": "compiles the new version"}.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "support/descriptor.hpp"
#include "support/diagnostic.hpp"
#include "support/file_identity.hpp"

namespace hysteron::tool {

/// The task's side; requests are answered one after the other, in a thread of their own.
class ChangeListener {
 public:
  /// Tells who asked what is being done, as the end of a sentence that begins with "the task".
  using Progress = std::function<void(std::string_view)>;
  using Answer = std::function<std::string(const std::string& request, const Progress& progress)>;
  /// Told whether there is no socket, where that changes.
  using Missing = std::function<void(bool)>;

  /// A socket of a task that is gone is replaced. Where the disk takes none now, or somebody deletes it, it is tried
  /// again. Throws InputError at `place`: HY815 where another task listens there, HY854 where there can be no socket.
  ChangeListener(const std::string& path, const Place& place, Answer answer, Missing missing = {});
  /// Waits for the answer that is being made.
  ~ChangeListener();
  ChangeListener(const ChangeListener&) = delete;
  ChangeListener& operator=(const ChangeListener&) = delete;
  ChangeListener(ChangeListener&&) = delete;
  ChangeListener& operator=(ChangeListener&&) = delete;

 private:
  [[nodiscard]] int listen();
  [[nodiscard]] bool listens_at_last();
  void look_after_name();
  void miss(const std::string& why) const;
  void serve();
  void serve_one(const Descriptor& client) const;

  std::string path_;
  Answer answer_;
  Missing missing_;
  Descriptor socket_{};
  Descriptor end_{};      ///< readable once it ends
  bool listens_ = false;  ///< of the thread, once there is one; so are the socket and its name
  std::optional<FileIdentity> named_{};
  std::thread thread_;
};

/// The answer of the task that listens there; where it takes longer than a second, `waits` is told for what. Throws
/// InputError HY852 where there is none of this user.
[[nodiscard]] std::string ask_task(const std::string& path, const Place& place, const std::string& request,
                                   const ChangeListener::Progress& waits);

}  // namespace hysteron::tool
