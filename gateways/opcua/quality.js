// Which StatusCode a value gets. The first row that fits counts; docs/how-to/opc-ua.md has the table.

/**
 * The texts of an enumeration as a point's meaning lists them, "0 starting, 1 running"; null where it lists none.
 * @param {string} meaning @returns {string[] | null}
 */
export function enumeration(meaning) {
  const texts = meaning.split(", ").map((part, number) =>
    part.startsWith(`${number} `) ? part.slice(`${number} `.length) : null);
  return texts.length > 1 && texts.every((text) => text !== null) ? texts : null;
}

/**
 * What a snapshot says of itself.
 * @param {{isLinked: boolean, isStalled: boolean, state: string, fault: string}} task
 * @param {{kind: string, low: number | null, high: number | null, isForced?: boolean}} point
 * @param {number | null} value null: not finite
 * @returns {string} the name of a StatusCode
 */
export function statusOf(task, point, value) {
  if (!task.isLinked) return "BadNoCommunication";
  if (value === null) return "BadOutOfRange";
  if (task.isStalled) return "UncertainLastUsableValue";
  if (point.kind === "parameter" || point.kind === "status") return "Good";
  if (task.state === "starting") return "UncertainInitialValue";
  if (task.state === "stopped") return "BadOutOfService";
  if (task.state === "faulted") {
    if (point.kind === "output") return "UncertainSubstituteValue";
    return task.fault === "stale input" || task.fault === "lost link" ? "UncertainLastUsableValue" : "UncertainSubNormal";
  }
  if (point.isForced) return "GoodLocalOverride";
  if ((point.low ?? -Infinity) > value || value > (point.high ?? Infinity)) return "UncertainEngineeringUnitsExceeded";
  return "Good";
}
