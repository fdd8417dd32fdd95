// What every connection through TLS has in common: the server's certificate and key, who signs clients' certificates,
// and what each role may do. Modbus/TCP Security: certificates on both sides, TLS 1.2 or newer, and the client's role
// in an extension of its certificate. The files of a client, MQTT's, are held to the same. Only the .cpp files of TLS
// see OpenSSL.
#pragma once

#include <cstdint>
#include <ctime>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/modbus/responder.hpp"
#include "support/diagnostic.hpp"

struct ssl_ctx_st;
struct x509_st;

namespace hysteron::runtime::modbus {

/// Of the extension that holds a client's role, one UTF8String.
inline constexpr const char* role_extension = "1.3.6.1.4.1.50316.802.1";

struct TlsOptions {
  std::string certificate{};  ///< files in PEM: the server's certificate, with those that lead to its root
  std::string key{};          ///< its private key, without a password
  std::string clients{};      ///< certificates that sign those of clients, or clients' own
  std::map<std::string, Rights, std::less<>> roles{};
  Rights without_role = no_rights;  ///< of a client whose certificate names no role
  Place certificate_place{};        ///< for errors
  Place key_place{};
  Place clients_place{};
};

/// The files that are read, each by its path: the certificate, its key, who signs those of clients.
[[nodiscard]] std::vector<std::string> files_of(const TlsOptions& options);

/// From when to when a certificate counts, in seconds since 1970.
struct Validity {
  std::time_t begins = 0;
  std::time_t ends = 0;
};

/// Why no client comes in, whatever it shows; task.tls_fault says it.
enum class TlsFault : std::uint8_t {
  none,
  ended,      ///< the server's certificate: clients refuse it
  not_begun,  ///< it, by the clock of this machine, to which a client's certificate does not count yet either
  signers,    ///< of those who sign clients' certificates, none counts
};

/// What becomes of certificates that do not count today. Where nothing serves yet, a control must not wait for them.
enum class OutOfDate : std::uint8_t { refused, taken };

class TlsContext {
 public:
  /// Throws InputError HY831 to HY834; the last one where out of date is refused.
  explicit TlsContext(const TlsOptions& options, OutOfDate out_of_date = OutOfDate::refused);

  /// What the owner of a certificate may do. A role that is not listed, or an extension that is not one role, may
  /// nothing.
  [[nodiscard]] Rights rights_of(const x509_st& certificate) const;
  /// Until when the server's certificate counts: 2027-05-01.
  [[nodiscard]] std::string valid_until() const;
  [[nodiscard]] std::time_t ends() const { return validity_.ends; }
  [[nodiscard]] TlsFault fault_at(std::time_t now) const;
  [[nodiscard]] ssl_ctx_st* context() const { return context_.get(); }

 private:
  struct Free {
    void operator()(ssl_ctx_st* context) const;
  };
  std::unique_ptr<ssl_ctx_st, Free> context_;
  std::map<std::string, Rights, std::less<>> roles_;
  Rights without_role_;
  Validity validity_{};              ///< of the server's certificate
  std::vector<Validity> signers_{};  ///< of those who sign clients'
};

/// Of a client of TLS, each by the path that counts.
struct TlsClientFiles {
  std::string authority{};    ///< certificates in PEM that sign the other side's
  std::string certificate{};  ///< its own, with its key; both empty where it shows none
  std::string key{};
  Place authority_place{};  ///< for errors
  Place certificate_place{};
  Place key_place{};
};

/// Throws InputError HY831 to HY834 where a client cannot use the files.
void check_client_files(const TlsClientFiles& files);

/// Others than the owner of a file may read it, or others than its owner change it. Its group may read it.
[[nodiscard]] bool is_open_to_others(const std::string& path);

/// The file that is named, or what the service manager hands over instead under the name of a credential.
[[nodiscard]] std::string credential_path(const std::string& path, const char* credential);

/// The names under which a service manager hands over the files, because it may read what the service's user may not.
/// A file that it hands over counts instead of the one that is named.
inline constexpr const char* certificate_credential = "tls-certificate";
inline constexpr const char* key_credential = "tls-key";
inline constexpr const char* clients_credential = "tls-clients";
inline constexpr const char* mqtt_ca_credential = "mqtt-ca";
inline constexpr const char* mqtt_certificate_credential = "mqtt-certificate";
inline constexpr const char* mqtt_key_credential = "mqtt-key";
inline constexpr const char* mqtt_password_credential = "mqtt-password";

}  // namespace hysteron::runtime::modbus
