// EUInformation of a unit as a diagram writes it: the code of UN/ECE Recommendation 20 where it has one.
// OPC 10000-8, 5.6.3: the identifier of a unit is its common code, a byte a character.

/** Of codes that the recommendation has. Prefixed symbols are listed one by one: their codes follow no rule. */
const CODES = new Map(Object.entries({
  m: ["MTR", "metre"], cm: ["CMT", "centimetre"], mm: ["MMT", "millimetre"], um: ["4H", "micrometre"],
  nm: ["C45", "nanometre"], pm: ["C52", "picometre"], km: ["KMT", "kilometre"],
  g: ["GRM", "gram"], kg: ["KGM", "kilogram"], mg: ["MGM", "milligram"], ug: ["MC", "microgram"],
  s: ["SEC", "second"], ms: ["C26", "millisecond"], us: ["B98", "microsecond"], ns: ["C47", "nanosecond"],
  min: ["MIN", "minute"], h: ["HUR", "hour"], d: ["DAY", "day"],
  A: ["AMP", "ampere"], kA: ["B22", "kiloampere"], mA: ["4K", "milliampere"], uA: ["B84", "microampere"],
  nA: ["C39", "nanoampere"], pA: ["C70", "picoampere"],
  K: ["KEL", "kelvin"], degC: ["CEL", "degree Celsius"], mol: ["C34", "mole"], cd: ["CDL", "candela"],
  N: ["NEW", "newton"], kN: ["B47", "kilonewton"], MN: ["B73", "meganewton"], mN: ["C20", "millinewton"],
  uN: ["B92", "micronewton"],
  Pa: ["PAL", "pascal"], hPa: ["A97", "hectopascal"], kPa: ["KPA", "kilopascal"], MPa: ["MPA", "megapascal"],
  GPa: ["A89", "gigapascal"], mPa: ["74", "millipascal"], uPa: ["B96", "micropascal"],
  bar: ["BAR", "bar"], mbar: ["MBR", "millibar"], kbar: ["KBA", "kilobar"],
  J: ["JOU", "joule"], kJ: ["KJO", "kilojoule"], MJ: ["3B", "megajoule"], mJ: ["C15", "millijoule"],
  W: ["WTT", "watt"], kW: ["KWT", "kilowatt"], MW: ["MAW", "megawatt"], mW: ["C31", "milliwatt"],
  uW: ["D80", "microwatt"],
  C: ["COU", "coulomb"], mC: ["D86", "millicoulomb"], uC: ["B86", "microcoulomb"], nC: ["C40", "nanocoulomb"],
  pC: ["C71", "picocoulomb"],
  V: ["VLT", "volt"], kV: ["KVT", "kilovolt"], MV: ["B78", "megavolt"], mV: ["2Z", "millivolt"],
  uV: ["D82", "microvolt"],
  F: ["FAR", "farad"], mF: ["C10", "millifarad"], uF: ["4O", "microfarad"], nF: ["C41", "nanofarad"],
  pF: ["4T", "picofarad"],
  Ohm: ["OHM", "ohm"], kOhm: ["B49", "kiloohm"], MOhm: ["B75", "megaohm"], mOhm: ["E45", "milliohm"],
  uOhm: ["B94", "microohm"],
  S: ["SIE", "siemens"], mS: ["C27", "millisiemens"], uS: ["B99", "microsiemens"],
  Wb: ["WEB", "weber"], mWb: ["C33", "milliweber"],
  T: ["D33", "tesla"], mT: ["C29", "millitesla"], uT: ["D81", "microtesla"], nT: ["C48", "nanotesla"],
  H: ["81", "henry"], mH: ["C14", "millihenry"], uH: ["B90", "microhenry"], nH: ["C43", "nanohenry"],
  Hz: ["HTZ", "hertz"], kHz: ["KHZ", "kilohertz"], MHz: ["MHZ", "megahertz"], GHz: ["A86", "gigahertz"],
  L: ["LTR", "litre"], mL: ["MLT", "millilitre"], uL: ["4G", "microlitre"],
  rpm: ["RPM", "revolutions per minute"], rev: ["M44", "revolution"], rad: ["C81", "radian"],
  mrad: ["C25", "milliradian"], urad: ["B97", "microradian"], deg: ["DD", "degree"],
  "%": ["P1", "percent"], ppm: ["59", "part per million"], 1: ["C62", "one"],
  "m/s": ["MTS", "metre per second"], "cm/s": ["2M", "centimetre per second"],
  "mm/s": ["C16", "millimetre per second"], "km/h": ["KMH", "kilometre per hour"],
  "m/min": ["2X", "metre per minute"], "mm/min": ["H81", "millimetre per minute"],
  "m/s^2": ["MSK", "metre per second squared"], "mm/s^2": ["M41", "millimetre per second squared"],
  "rad/s": ["2A", "radian per second"], "rad/s^2": ["2B", "radian per second squared"],
  "deg/s": ["E96", "degree per second"], "deg/s^2": ["M45", "degree per second squared"],
  "rev/s": ["RPS", "revolutions per second"],
  "N*m": ["NU", "newton metre"], "mN*m": ["D83", "millinewton metre"], "kN*m": ["B48", "kilonewton metre"],
  "N*m/rad": ["M93", "newton metre per radian"], "N*m/A": ["F90", "newton metre per ampere"],
  "N/A": ["H40", "newton per ampere"], "N/m": ["4P", "newton per metre"], "kN/m": ["N31", "kilonewton per metre"],
  "N/mm": ["F47", "newton per millimetre"], "N*s": ["C57", "newton second"],
  "N*s/m": ["C58", "newton second per metre"], "Pa*s": ["C65", "pascal second"],
  "kg*m^2": ["B32", "kilogram metre squared"], "kg/m^3": ["KMQ", "kilogram per cubic metre"],
  "m^2": ["MTK", "square metre"], "mm^2": ["MMK", "square millimetre"], "cm^2": ["CMK", "square centimetre"],
  "m^3": ["MTQ", "cubic metre"], "mm^3": ["MMQ", "cubic millimetre"], "cm^3": ["CMQ", "cubic centimetre"],
  "m^2/s": ["S4", "square metre per second"], "m^3/s": ["MQS", "cubic metre per second"],
  "m^3/h": ["MQH", "cubic metre per hour"], "L/s": ["G51", "litre per second"], "L/min": ["L2", "litre per minute"],
  "mL/s": ["40", "millilitre per second"], "mL/min": ["41", "millilitre per minute"],
  "kg/s": ["KGS", "kilogram per second"], "kg/h": ["E93", "kilogram per hour"], "g/s": ["F29", "gram per second"],
  "1/s": ["C97", "reciprocal second"], "s^-1": ["C97", "reciprocal second"], "1/min": ["C94", "reciprocal minute"],
  "1/m": ["C92", "reciprocal metre"], "1/K": ["C91", "reciprocal kelvin"],
  "K/s": ["F12", "kelvin per second"], "K/min": ["F11", "kelvin per minute"], "K/W": ["B21", "kelvin per watt"],
  "W/K": ["D52", "watt per kelvin"], "degC/s": ["H14", "degree Celsius per second"],
  "degC/min": ["H13", "degree Celsius per minute"],
  "J/K": ["JE", "joule per kelvin"], "J/(kg*K)": ["B11", "joule per kilogram kelvin"],
  "W/(m*K)": ["D53", "watt per metre kelvin"], "W/(m^2*K)": ["D55", "watt per square metre kelvin"],
  "W/m^2": ["D54", "watt per square metre"], "V/m": ["D50", "volt per metre"], "V/s": ["H46", "volt per second"],
  "V/mm": ["D51", "volt per millimetre"], "V/K": ["D48", "volt per kelvin"], "A/m": ["AE", "ampere per metre"],
  "A*h": ["AMH", "ampere hour"], "W*h": ["WHR", "watt hour"], "kW*h": ["KWH", "kilowatt hour"],
}));

const UNECE = "http://www.opcfoundation.org/UA/units/un/cefact";
const OWN = "urn:hysteron:units";

/** The one way to write a unit that the table has: u for µ, Ohm for Ω, L for l, no blanks. */
function canonical(unit) {
  return unit.replaceAll(/[µμ]/g, "u").replaceAll("°C", "degC").replaceAll("Ω", "Ohm").replaceAll("·", "*")
    .replaceAll(" ", "").replaceAll(/\b([mu]?)l\b/g, "$1L");
}

/** @param {string} code of up to three characters @returns {number} */
export function unitIdOf(code) {
  return [...code].reduce((id, letter) => id * 256 + letter.charCodeAt(0), 0);
}

/**
 * The fields of an EUInformation. A unit without a code keeps its text, with the identifier -1.
 * @param {string} unit as the diagram has it, "1" where it has none
 */
export function engineeringUnits(unit) {
  const known = CODES.get(canonical(unit));
  return {
    namespaceUri: known ? UNECE : OWN,
    unitId: known ? unitIdOf(known[0]) : -1,
    displayName: { text: unit },
    description: { text: known ? known[1] : unit },
  };
}
