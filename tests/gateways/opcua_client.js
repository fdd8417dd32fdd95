// An OPC UA client that does what it is told, a JSON command a line, and answers each with a line: {"result"} or
// {"error"}. So a test can kill and start the task while a session goes on.
//
//   node opcua_client.js FOLDER PKI    the folder of the gateway, for its library; and a folder for the client's own key
"use strict";

const { createRequire } = require("node:module");
const { createInterface } = require("node:readline");
const path = require("node:path");

const opcua = createRequire(path.join(path.resolve(process.argv[2]), "package.json"))("node-opcua");
const { AttributeIds, constructEventFilter, DataType, MessageSecurityMode, OPCUACertificateManager, OPCUAClient, ofType,
  SecurityPolicy, TimestampsToReturn, UserTokenType } = opcua;
opcua.setWarningLogger(() => {});
opcua.setErrorLogger(() => {});

const NAMESPACE = "urn:hysteron:task";
const clients = [];
const seen = {};
let session = null;
let prefix = "";
let manager = null;

async function connected(url, { policy = "None", user, password } = {}) {
  const mode = policy === "None" ? MessageSecurityMode.None : MessageSecurityMode.SignAndEncrypt;
  const client = OPCUAClient.create({
    applicationName: "test", endpointMustExist: false, securityMode: mode, securityPolicy: SecurityPolicy[policy],
    clientCertificateManager: manager, connectionStrategy: { maxRetry: 0, initialDelay: 100 }, keepSessionAlive: true,
    requestedSessionTimeout: 60_000,
  });
  await client.connect(url);
  clients.push(client);
  return client.createSession(user ? { type: UserTokenType.UserName, userName: user, password } : { type: UserTokenType.Anonymous });
}

/** A value as JSON has it; integers of 64 bits as numbers. */
function plain({ dataType, value }) {
  if (dataType === DataType.UInt64 || dataType === DataType.Int64) return value[0] * 2 ** 32 + value[1];
  return typeof value === "number" && !Number.isFinite(value) ? String(value) : value;
}

function told(dataValue) {
  return {
    value: dataValue.value ? plain(dataValue.value) : null, type: dataValue.value ? DataType[dataValue.value.dataType] : null,
    status: dataValue.statusCode.name, source: dataValue.sourceTimestamp?.getTime() ?? null,
  };
}

const commands = {
  async connect({ url, ...how }) {
    session = await connected(url, how);
    prefix = `ns=${(await session.readNamespaceArray()).indexOf(NAMESPACE)};s=`;
    return null;
  },
  /** So many sessions more, each with a subscription to all these nodes; how many came about, and the first refusal. */
  async crowd({ url, count, nodes, how }) {
    let made = 0;
    let refusal = null;
    for (let i = 0; i < count; ++i) {
      try {
        const one = await connected(url, how);
        await watch(one, nodes, 50, () => {});
        made += 1;
      } catch (problem) {
        refusal ??= problem.message;
      }
    }
    return { made, refusal };
  },
  async endpoints({ url }) {
    const client = OPCUAClient.create({ endpointMustExist: false, clientCertificateManager: manager, connectionStrategy: { maxRetry: 0 } });
    await client.connect(url);
    const all = await client.getEndpoints();
    await client.disconnect();
    return all.map((one) => [one.securityPolicyUri.split("#")[1], MessageSecurityMode[one.securityMode]]);
  },
  async browse({ node }) {
    const { references } = await session.browse(prefix + node);
    return references.map((one) => one.browseName.name);
  },
  async attributes({ node }) {
    const of = async (name) => (await session.read({ nodeId: prefix + node, attributeId: AttributeIds[name] })).value.value;
    const { references } = await session.browse({ nodeId: prefix + node, referenceTypeId: "HasTypeDefinition", resultMask: 63 });
    return { description: (await of("Description")).text, access: await of("AccessLevel"), mine: await of("UserAccessLevel"),
      is: references[0].browseName.name };
  },
  async read({ node }) {
    return told(await session.read({ nodeId: node.startsWith("ns=") ? node : prefix + node, attributeId: AttributeIds.Value }));
  },
  async write({ node, value, type = "Double" }) {
    const status = await session.write({
      nodeId: prefix + node, attributeId: AttributeIds.Value, value: { value: { dataType: DataType[type], value } },
    });
    return status.name;
  },
  async call({ method }) {
    const { statusCode, outputArguments } = await session.call({
      objectId: `${prefix}Parameters`, methodId: `${prefix}Parameters.${method}` });
    return { status: statusCode.name, refusal: outputArguments?.[0]?.value ?? null };
  },
  async watch({ nodes, interval }) {
    const revised = await watch(session, nodes, interval, (node, dataValue) => (seen[node] ??= []).push(told(dataValue)));
    return revised;
  },
  /** From now on, events of this type are seen as "events". */
  async events({ type }) {
    const subscription = await subscribed(session, 50);
    const filter = constructEventFilter(["EventType", "Changes"], ofType(type));
    const item = await subscription.monitor({ nodeId: "ns=0;i=2253", attributeId: AttributeIds.EventNotifier },
      { samplingInterval: 0, queueSize: 100, discardOldest: true, filter }, TimestampsToReturn.Both);
    item.on("changed", ([, changes]) => (seen.events ??= []).push(changes.value.map((one) => one.affected.toString())));
    return item.result.statusCode.name;
  },
  async property({ node, name }) {
    const { references } = await session.browse({ nodeId: prefix + node, referenceTypeId: "HasProperty", resultMask: 63 });
    const found = references.find((one) => one.browseName.name === name);
    return told(await session.read({ nodeId: found.nodeId, attributeId: AttributeIds.Value }));
  },
  async namespace_version() {
    const inServer = async (nodeId, name) => (await session.browse({ nodeId, resultMask: 63 })).references
      .find((one) => one.browseName.name === name).nodeId;
    const metadata = await inServer("ns=0;i=11715", NAMESPACE);
    return told(await session.read({ nodeId: await inServer(metadata, "NamespaceVersion"), attributeId: AttributeIds.Value }));
  },
  async seen({ node }) {
    return seen[node] ?? [];
  },
  async close() {
    await Promise.all(clients.map((client) => client.disconnect()));
    return null;
  },
};

function subscribed(on, interval) {
  return on.createSubscription2({
    requestedPublishingInterval: interval, requestedLifetimeCount: 600, requestedMaxKeepAliveCount: 20, publishingEnabled: true,
    maxNotificationsPerPublish: 0,
  });
}

async function watch(on, nodes, interval, give) {
  const subscription = await subscribed(on, interval);
  const revised = [];
  for (const node of nodes) {
    const item = await subscription.monitor({ nodeId: prefix + node, attributeId: AttributeIds.Value },
      { samplingInterval: interval, queueSize: 100, discardOldest: true }, TimestampsToReturn.Both);
    item.on("changed", (dataValue) => give(node, dataValue));
    revised.push(item.result.revisedSamplingInterval);
  }
  return revised;
}

async function main() {
  manager = new OPCUACertificateManager({ rootFolder: process.argv[3], automaticallyAcceptUnknownCertificate: true });
  await manager.initialize();
  for await (const line of createInterface({ input: process.stdin })) {
    const { command, ...given } = JSON.parse(line);
    let answer;
    try {
      answer = { result: await commands[command](given) };
    } catch (problem) {
      answer = { error: problem.message };
    }
    process.stdout.write(`${JSON.stringify(answer)}\n`);
  }
  process.exit(0);
}

main();
