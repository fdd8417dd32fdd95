// The OPC UA server itself: who may reach it, by which security, and how much of it at once.

import { existsSync, mkdirSync } from "node:fs";
import { isIP } from "node:net";
import { hostname, networkInterfaces } from "node:os";
import { join } from "node:path";

import {
  makeApplicationUrn, MessageSecurityMode, OPCUACertificateManager, OPCUAServer, resolveNodeId, SecurityPolicy, setErrorLogger,
  setWarningLogger, WellKnownRoles,
} from "node-opcua";

import { Door } from "./door.js";

const ROLES = { read: WellKnownRoles.Observer, write: WellKnownRoles.Operator };

const CERTIFICATE_DAYS = 3650;
const GUESTS = 32; // connections without a session: who asks for the endpoints, and who is about to have one
const PATIENCE = 10_000; // ms, of which a session needs less than one
const CLOSING = 256; // connections that are pushed out, and are not closed yet
const LINE_PAUSE = 1_000; // ms: what a client can make the library say fills no log
const OF_NO_INTEREST = /NODE-OPCUA-W27|security-revert/; // about the padding of a policy that is not offered here

/** A line in LINE_PAUSE at most; the others are dropped. @param {(line: string) => void} tell */
function atMost(tell) {
  let next = 0;
  return (line) => {
    if (performance.now() < next) return;
    next = performance.now() + LINE_PAUSE;
    tell(line);
  };
}

/** What the library says goes where ours goes. @param {(line: string) => void} tell */
function listenToLibrary(tell) {
  const seldom = atMost(tell);
  const log = (...parts) => {
    const line = parts.map(String).join(" ").replace(/\x1b\[[0-9;]*m/g, "").replace(/\s+/g, " ").slice(0, 300);
    if (!OF_NO_INTEREST.test(line)) seldom(`node-opcua: ${line}`);
  };
  setWarningLogger(log);
  setErrorLogger(log);
}

/** @param {string} address */
export function isLoopback(address) {
  return address === "::1" || address === "localhost" || (isIP(address) === 4 && address.startsWith("127."));
}

/** A folder of certificates: own, trusted, rejected. @param {string} folder */
async function store(folder) {
  mkdirSync(folder, { recursive: true, mode: 0o700 });
  const manager = new OPCUACertificateManager({ rootFolder: folder, automaticallyAcceptUnknownCertificate: false });
  await manager.initialize();
  return manager;
}

/** Made once: clients that trust it go on doing so. @param {OPCUACertificateManager} keys */
async function ownCertificate(keys, { applicationUri, address, isAnyAddress, tell }) {
  const outputFile = join(keys.rootDir, "own", "certs", "certificate.pem");
  if (!existsSync(outputFile)) {
    await keys.createSelfSignedCertificate({
      applicationUri, outputFile, subject: `/CN=Hysteron@${hostname()}`, startDate: new Date(), validity: CERTIFICATE_DAYS,
      dns: [...new Set([hostname(), "localhost"])], ip: isIP(address) && !isAnyAddress ? [address] : addressesOfThisMachine(),
    });
    tell(`A certificate was made: ${outputFile}.`);
  }
  return outputFile;
}

function addressesOfThisMachine() {
  return Object.values(networkInterfaces()).flat().filter(({ family }) => family === "IPv4").map(({ address }) => address);
}

/**
 * A server that does not listen yet. Its certificate and key are made in the state folder where they are not there.
 * @param {{address: string, port: number, state: string, users: import("./users.js").Users | null, isAnonymous: boolean,
 *   sessions: number, interval: number, version: string, tell: (line: string) => void}} options
 */
export async function makeServer({ address, port, state, users, isAnonymous, sessions, interval, version, tell }) {
  listenToLibrary(tell);
  mkdirSync(state, { recursive: true, mode: 0o700 });
  // On the loopback nobody listens on the way; elsewhere nothing goes in the clear.
  const isOpen = isLoopback(address);
  const isAnyAddress = address === "0.0.0.0" || address === "::";
  const applicationUri = makeApplicationUrn(hostname(), "hysteron-opcua");
  const keys = await store(join(state, "pki"));
  const server = new OPCUAServer({
    host: address,
    port,
    hostname: isAnyAddress ? hostname() : address,
    securityPolicies: [
      SecurityPolicy.Basic256Sha256, SecurityPolicy.Aes128_Sha256_RsaOaep, SecurityPolicy.Aes256_Sha256_RsaPss,
      ...(isOpen ? [SecurityPolicy.None] : []),
    ],
    securityModes: [MessageSecurityMode.SignAndEncrypt, ...(isOpen ? [MessageSecurityMode.None] : [])],
    serverCertificateManager: keys,
    certificateFile: await ownCertificate(keys, { applicationUri, address, isAnyAddress, tell }),
    privateKeyFile: keys.privateKey,
    userCertificateManager: await store(join(state, "user-pki")),
    allowAnonymous: isAnonymous,
    allowAnonymousSubscriptionTransferOnUnsecuredChannel: false,
    userManager: {
      isValidUserAsync: (name, password, done) => {
        if (!users) return done(null, false);
        users.isPassword(name, password).then((is) => {
          if (!is) tell(`A wrong name or password was given for ${JSON.stringify(name.slice(0, 64))}.`);
          done(null, is);
        }, (problem) => done(problem));
      },
      getUserRoles: (name) => {
        const role = ROLES[users?.rightOf(name)];
        return role === undefined ? [] : [resolveNodeId(role)];
      },
    },
    unresolvedPermissionPolicy: "allow",
    serverInfo: {
      applicationUri,
      productUri: "urn:hysteron:opcua",
      applicationName: { text: "Hysteron" },
    },
    buildInfo: { productName: "hysteron-opcua", productUri: "urn:hysteron:opcua", manufacturerName: "Hysteron", softwareVersion: version },
    isAuditing: false,
    maxConnectionsPerEndpoint: sessions + GUESTS + CLOSING, // the door bounds them before
    serverCapabilities: {
      maxSessions: sessions,
      maxSubscriptionsPerSession: 8,
      maxSubscriptions: 4 * sessions,
      maxMonitoredItemsPerSubscription: 10_000,
      maxMonitoredItems: 100_000,
      maxMonitoredItemsQueueSize: 1_000,
      minSupportedSampleRate: interval,
      operationLimits: {
        maxNodesPerRead: 10_000, maxNodesPerBrowse: 10_000, maxNodesPerWrite: 1_000, maxNodesPerMethodCall: 10,
        maxMonitoredItemsPerCall: 10_000, maxNodesPerTranslateBrowsePathsToNodeIds: 10_000, maxNodesPerRegisterNodes: 10_000,
      },
    },
  });
  const door = new Door({ guests: GUESTS, patience: PATIENCE, tell: atMost(tell) });
  door.watch(() => server.endpoints[0]?.port ?? port);
  server.on("session_activated", (session) => door.seat(session, session.channel));
  server.on("session_closed", (session) => door.leave(session));
  await server.initialize();
  return server;
}
