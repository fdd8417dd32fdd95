// The points of a task as nodes of OPC UA, in folders as the task has them. Values are read from the newest snapshot
// when a client samples them; a write goes to the task as a staged parameter. docs/how-to/opc-ua.md has the mapping.

import {
  DataType, DataValue, makeAccessLevelFlag, makePermissionFlag, resolveNodeId, setNamespaceMetaData, StatusCodes, Variant,
  VariantArrayType, WellKnownRoles,
} from "node-opcua";

import { enumeration, statusOf } from "./quality.js";
import { SourceTime } from "./source_time.js";
import { Refused, Unfit } from "./task_link.js";
import { engineeringUnits } from "./units.js";

export const NAMESPACE = "urn:hysteron:task";
const FOLDERS = { input: "Inputs", output: "Outputs", parameter: "Parameters", status: "Status", signal: "Signals" };
const DATA_TYPES = {
  boolean: DataType.Boolean, int16: DataType.Int16, uint16: DataType.UInt16, int32: DataType.Int32, uint32: DataType.UInt32,
  int64: DataType.Int64, uint64: DataType.UInt64, real32: DataType.Float, real64: DataType.Double,
};
const PATIENCE = 2_000; // ms; and ten periods, and three looks: a snapshot that stays for longer has stalled

/** @param {DataType} type @param {number | null} value */
function variantOf(type, value) {
  const isReal = type === DataType.Double || type === DataType.Float;
  const number = value ?? (isReal ? NaN : 0);
  if (type === DataType.Boolean) return new Variant({ dataType: type, value: number !== 0 });
  if (type === DataType.Int64 || type === DataType.UInt64) {
    const bits = BigInt.asUintN(64, BigInt(Math.trunc(number)));
    const words = [Number(bits >> 32n), Number(bits & 0xffffffffn)];
    return new Variant({ dataType: type, arrayType: VariantArrayType.Scalar, value: words });
  }
  return new Variant({ dataType: type, value: isReal ? number : Math.trunc(number) });
}

/** @param {Variant} variant @returns {number | boolean} */
function numberIn({ dataType, value }) {
  if (dataType !== DataType.Int64 && dataType !== DataType.UInt64) return value;
  const bits = (BigInt(value[0]) << 32n) | BigInt(value[1]);
  return Number(dataType === DataType.Int64 ? BigInt.asIntN(64, bits) : bits);
}

/** @param {any} point */
function descriptionOf({ meaning, unit, low, high, data_type }) {
  const limit = (words, value) => (value === null ? [] : [`${words} ${value}${unit === "1" ? "" : ` ${unit}`}`]);
  const limits = data_type === "boolean" ? [] : [...limit("at least", low), ...limit("at most", high)];
  return [...(meaning ? [meaning] : []), ...limits].join("; ");
}

export class TaskSpace {
  #space;
  #namespace;
  #options;
  #link;
  #tell;
  #folders = {};
  #nodes = new Map(); // by identifier: {key, node}
  #methods = [];
  #points = []; // of the newest description, with `of` and `at`: where the value is
  #time = new SourceTime(0);
  #task = { name: "", period: 0, layout: "" };
  #seen = { cycle: -1, at: 0, values: [], inner: [], staged: [], forced: [], time: new Date(0), state: "", fault: "" };
  #isLinked = false;
  #lastRefusal = "";

  /**
   * @param {any} space the server's address space
   * @param {{interval: number, isWritable: boolean}} options the interval in ms
   * @param {import("./task_link.js").TaskLink} link
   * @param {(line: string) => void} tell
   */
  constructor(space, options, link, tell) {
    this.#space = space;
    this.#options = options;
    this.#link = link;
    this.#tell = tell;
    this.#namespace = space.registerNamespace(NAMESPACE);
    const read = makePermissionFlag("Browse | Read | ReceiveEvents");
    const all = makePermissionFlag("Browse | Read | ReceiveEvents | Write | Call");
    this.#namespace.setDefaultRolePermissions([
      // Every session has the rights of Anonymous; there is an anonymous one only where it was asked for.
      { roleId: resolveNodeId(WellKnownRoles.Anonymous), permissions: read },
      { roleId: resolveNodeId(WellKnownRoles.Observer), permissions: read },
      { roleId: resolveNodeId(WellKnownRoles.Operator), permissions: all },
    ]);
    setNamespaceMetaData(this.#namespace);
    // What the library brings along, it leaves open to writes where it says nothing.
    const look = [{ roleId: resolveNodeId(WellKnownRoles.Anonymous), permissions: makePermissionFlag("Browse | Read | ReceiveEvents | Call") }];
    for (const index of [0, 1]) {
      space.getNamespace(index).setDefaultRolePermissions(look);
    }
    this.#addFixedNodes();
  }

  // ---- what the link says ----

  /** @param {any} description @param {string} layout */
  describe(description, layout) {
    const isAnother = this.#task.layout !== layout;
    this.#time = new SourceTime(description.period);
    this.#seen = { ...this.#seen, cycle: -1 };
    this.#isLinked = false; // until its values are there
    if (!isAnother) return;
    const points = [
      ...description.points.map((point, at) => ({ ...point, of: "values", at })),
      ...description.inner.map((signal, at) => ({ low: null, high: null, meaning: "", ...signal, kind: "signal", of: "inner", at })),
    ].filter((point) => FOLDERS[point.kind]);
    if (!points.every((point) => point.data_type in DATA_TYPES)) {
      throw new Unfit("its description has no types that are known here; is it of another version of Hysteron?");
    }
    this.#points = points;
    this.#task = { name: description.name, period: description.period, layout };
    this.#space.modelChangeTransaction(() => this.#rebuild(description.writable && this.#options.isWritable));
    this.#metadata("NamespaceVersion", DataType.String, layout.slice(0, 16));
    this.#metadata("NamespacePublicationDate", DataType.DateTime, new Date());
  }

  /** @param {any} snapshot */
  update(snapshot) {
    const of = (name) => {
      const point = this.#points.find((one) => one.name === name);
      return { value: snapshot.values[point?.at] ?? 0, meaning: point?.meaning ?? "" };
    };
    const text = ({ value, meaning }) => enumeration(meaning)?.[value] ?? "";
    this.#seen = {
      ...snapshot, forced: snapshot.forced ?? [], at: snapshot.cycle === this.#seen.cycle ? this.#seen.at : performance.now(),
      time: this.#time.of(of("task.elapsed").value), state: text(of("task.state")), fault: text(of("task.fault")),
    };
    this.#isLinked = true;
  }

  lost() {
    this.#isLinked = false;
  }

  get isLinked() {
    return this.#isLinked;
  }
  get name() {
    return this.#task.name;
  }
  get layout() {
    return this.#task.layout;
  }
  get size() {
    return this.#nodes.size;
  }

  // ---- nodes ----

  #addFixedNodes() {
    const task = this.#namespace.addObject({
      browseName: "Task", nodeId: "s=Task", organizedBy: this.#space.rootFolder.objects, nodeVersion: "1",
    });
    for (const name of Object.values(FOLDERS)) {
      this.#folders[name] = this.#namespace.addObject({
        browseName: name, nodeId: `s=${name}`, componentOf: task, typeDefinition: "FolderType", nodeVersion: "1",
      });
    }
    for (const { nodeVersion } of [task, ...Object.values(this.#folders)]) {
      nodeVersion.accessLevel = nodeVersion.userAccessLevel = makeAccessLevelFlag("CurrentRead");
    }
    const add = (parent, name, dataType, description, get, more = {}) => this.#namespace.addVariable({
      browseName: name, nodeId: `s=${parent.browseName.name}.${name}`, componentOf: parent, dataType, description,
      minimumSamplingInterval: this.#options.interval, accessLevel: "CurrentRead", ...more,
      value: { timestamped_get: () => this.#ownValue(new Variant({ dataType, value: get(), ...(more.valueRank === 1 ? { arrayType: VariantArrayType.Array } : {}) })) },
    });
    add(task, "Connected", DataType.Boolean, "whether the task answers", () => this.#isLinked);
    add(task, "Program", DataType.String, "the name of the diagram", () => this.#task.name);
    add(task, "Period", DataType.Double, "of the cycle, in ms", () => this.#task.period * 1000);
    add(task, "Layout", DataType.String, "SHA-256 of names, types, units and limits", () => this.#task.layout);
    add(this.#folders.Parameters, "Waiting", DataType.String, "parameters that wait for a commit, and their values",
      () => this.#waiting(), { valueRank: 1 });
    add(this.#folders.Parameters, "LastRefusal", DataType.String, "why the task refused the newest write or commit",
      () => this.#lastRefusal);
  }

  /** Nodes that are still the same stay, with those who watch them. */
  #rebuild(isWritable) {
    const wanted = new Map(this.#points.map((point) => [`${FOLDERS[point.kind]}/${point.name}`, point]));
    for (const [id, { key, node }] of this.#nodes) {
      if (!wanted.has(id) || key !== this.#keyOf(wanted.get(id), isWritable)) {
        this.#space.deleteNode(node);
        this.#nodes.delete(id);
      }
    }
    for (const [id, point] of wanted) {
      const key = this.#keyOf(point, isWritable);
      const kept = this.#nodes.get(id);
      if (kept) {
        kept.holder.point = point;
      } else {
        const holder = { point };
        this.#nodes.set(id, { key, holder, node: this.#addPoint(id, holder, isWritable && point.kind === "parameter") });
      }
    }
    this.#methods.splice(0).forEach((method) => this.#space.deleteNode(method));
    if (isWritable) {
      this.#methods.push(
        this.#addMethod("Commit", "all parameters that wait count from the next step on, or none", () => this.#link.commit()),
        this.#addMethod("Discard", "the parameters that wait are forgotten", () => this.#link.discard()));
    }
  }

  #keyOf({ of: _of, at: _at, ...point }, isWritable) {
    return JSON.stringify([point, isWritable && point.kind === "parameter"]);
  }

  #addPoint(id, holder, isWritable) {
    const { name, kind, unit, low, high, meaning, data_type } = holder.point;
    const dataType = DATA_TYPES[data_type];
    const texts = kind === "status" && dataType === DataType.UInt16 ? enumeration(meaning) : null;
    const isNumber = dataType !== DataType.Boolean && !texts;
    const hasUnit = isNumber && unit !== "1";
    const hasRange = isNumber && low !== null && high !== null;
    const typeDefinition = dataType === DataType.Boolean ? "TwoStateDiscreteType"
      : texts ? "MultiStateDiscreteType"
        : hasRange ? "AnalogItemType" : hasUnit ? "AnalogUnitType" : "BaseDataVariableType";
    const get = () => this.#valueOf(holder.point, dataType);
    const node = this.#namespace.addVariable({
      browseName: name, nodeId: `s=${id}`, componentOf: this.#folders[FOLDERS[kind]], dataType, typeDefinition,
      description: descriptionOf(holder.point), minimumSamplingInterval: this.#options.interval,
      accessLevel: isWritable ? "CurrentRead | CurrentWrite" : "CurrentRead",
      value: isWritable
        ? { timestamped_get: get, timestamped_set: (given, done) => void this.#write(holder.point, given, get).then((status) => done(null, status)) }
        : { timestamped_get: get },
    });
    const property = (browseName, type, value, more = {}) => this.#namespace.addVariable({
      browseName: { name: browseName, namespaceIndex: 0 }, nodeId: `s=${id}.${browseName}`, propertyOf: node, dataType: type,
      typeDefinition: "PropertyType", accessLevel: "CurrentRead", ...more,
      value: new Variant({ dataType: typeof type === "string" ? DataType.ExtensionObject : type, value, ...(more.valueRank === 1 ? { arrayType: VariantArrayType.Array } : {}) }),
    });
    const structure = (type, fields) => property(type === "Range" ? "EURange" : "EngineeringUnits", type,
      this.#space.constructExtensionObject(this.#space.findDataType(type), fields));
    if (hasUnit) structure("EUInformation", engineeringUnits(unit));
    if (hasRange) structure("Range", { low, high });
    if (texts) property("EnumStrings", DataType.LocalizedText, texts.map((text) => ({ text })), { valueRank: 1 });
    if (dataType === DataType.Boolean) {
      property("TrueState", DataType.LocalizedText, { text: "TRUE" });
      property("FalseState", DataType.LocalizedText, { text: "FALSE" });
    }
    return node;
  }

  #addMethod(name, description, act) {
    const method = this.#namespace.addMethod(this.#folders.Parameters, {
      browseName: name, nodeId: `s=Parameters.${name}`, description, inputArguments: [],
      outputArguments: [{ name: "Refusal", dataType: DataType.String, description: "why the task refused; empty where it did not" }],
    });
    method.bindMethod(async (_inputs, context) => {
      const { status, words } = await this.#asked(act, StatusCodes.BadInvalidState);
      this.#tell(`${name} by ${context.getUserName()}: ${words || "taken"}`);
      return { statusCode: status, outputArguments: [{ dataType: DataType.String, value: words }] };
    });
    return method;
  }

  // ---- values ----

  #valueOf(point, dataType) {
    const value = this.#seen[point.of][point.at] ?? null;
    const isForced = point.of === "values" && this.#seen.forced.includes(point.at);
    return new DataValue({
      value: variantOf(dataType, value), statusCode: StatusCodes[statusOf(this.#stateOfTask(), { ...point, isForced }, value)],
      sourceTimestamp: this.#seen.time, serverTimestamp: new Date(),
    });
  }

  #stateOfTask() {
    const patience = Math.max(PATIENCE, 10_000 * this.#task.period, 3 * this.#options.interval);
    const { state, fault, at } = this.#seen;
    return { isLinked: this.#isLinked, isStalled: performance.now() - at > patience, state, fault };
  }

  #ownValue(value) {
    const now = new Date();
    return new DataValue({ value, statusCode: StatusCodes.Good, sourceTimestamp: now, serverTimestamp: now });
  }

  #waiting() {
    const of = (at) => this.#points.find((point) => point.of === "values" && point.at === at)?.name;
    return this.#seen.staged.map(([at, value]) => `${of(at)} = ${value}`);
  }

  #metadata(name, dataType, value) {
    const all = this.#space.rootFolder.objects.server.getChildByName("Namespaces");
    all.getChildByName(NAMESPACE).getChildByName(name).setValueFromSource({ dataType, value });
  }

  // ---- orders ----

  /** The library keeps what it is given as the value; so it is given what still counts: a staged value does not. */
  async #write(point, given, get) {
    const value = numberIn(given.value);
    const { status } = await this.#asked(() => this.#link.stage({ [point.name]: value }), StatusCodes.BadOutOfRange);
    const { value: current, statusCode, sourceTimestamp, serverTimestamp } = get();
    Object.assign(given, { value: current, statusCode, sourceTimestamp, serverTimestamp });
    return status;
  }

  /** Does it, and says how it went: a StatusCode, `refusal` where the task refused it, and the task's words. */
  async #asked(act, refusal) {
    if (!this.#isLinked) return { status: StatusCodes.BadNoCommunication, words: "The task does not answer." };
    try {
      await act();
      return { status: StatusCodes.Good, words: "" };
    } catch (problem) {
      this.#lastRefusal = problem.message;
      if (!(problem instanceof Refused)) return { status: StatusCodes.BadNoCommunication, words: problem.message };
      const status = problem.status === 422 ? refusal : problem.status === 403 ? StatusCodes.BadNotWritable : StatusCodes.BadInvalidState;
      return { status, words: problem.message };
    }
  }
}
