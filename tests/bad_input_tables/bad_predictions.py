"""Bad options of `microslip predict`, each with a part of its error message.

A row has the options that differ from a valid command line (None: missing) and the part.  There is
one row for each cause of an error.
"""

GOOD = {"material": "steel", "radius": "5 mm", "load": "10 N", "mu": "0.3", "speed": "10 mm/s"}
GOOD |= {"amplitude": "1 um", "frequency": "20 kHz", "tolerance": "0.1"}
FORCED = {"speed": None, "force": "1 N"}
SPRUNG = {"drive_stiffness": "1 N/um"}
SIZED = {"radius": None, "contact_radius": "1 mm"}
STEADY = {"amplitude": None, "frequency": None, "rotation": "1 Hz"}
ELASTIC = {"material": None, "young": "210 GPa", "nu": "0.3"}
PRESSED = {"motion": "normal", "amplitude": None}
SEARCH = {"amplitude": None, "reduction": "50 %"}
MOTIONS = [
    ({"motion": "Transverse"}, "MOTION = 'Transverse': did you mean transverse?"),
    ({"motion": "normal:lateral=0.5"}, "allowed is normal with --load-amplitude"),
    ({"motion": "transverse-bore:angle=0.5"}, "for both use transverse-bore"),
    ({"amplitude": None}, "--amplitude: transverse needs it"),
    ({"amplitude": "1 deg"}, "--amplitude = '1 deg': the unit is deg"),
    ({"amplitude": "-1 um"}, "--amplitude = '-1 um': allowed is a finite value at least 0 m"),
    ({"amplitude": "1 m"}, "times the 2.17e-07 m at which the whole contact slides; allowed is"),
    ({"motion": "bore", "amplitude": "1e9 turn"}, "at which the stick radius is half"),
    ({"frequency": "0 Hz"}, "--frequency = '0 Hz': allowed is a finite value above 0 Hz"),
    ({"frequency": "20 s^-1"}, "may mean Hz or rad/s"),
    ({"rotation": "10 rpm"}, "--rotation = '10 rpm': transverse has none"),
    ({"forward_amplitude": "1 um"}, "--forward-amplitude = '1 um': transverse has none"),
    ({"motion": "elliptic"}, "--forward-amplitude: elliptic needs it"),
    ({"motion": "elliptic", "amplitude": "0 m", "forward_amplitude": "0 m"}, "--amplitude = '0 m'"),
    ({"motion": "normal", "amplitude": None, "load_amplitude": "1e10 N"}, "allowed is at most 1e"),
]
CONTACTS = [
    ({"load": None}, "--load: needed"),
    ({"load": "nan N"}, "it is not finite"),
    ({"load": "10 kg"}, "--load = '10 kg': the unit is kg"),
    ({"load": "1\n2 N"}, r"--load = '1\n2 N': "),
    ({"mu": None}, "--mu: needed"),
    ({"mu": "0,3"}, "--mu = '0,3': read 0 and stopped at ',3', since decimals follow a point"),
    ({"mu": "1100 %"}, "--mu = '1100 %': allowed is a finite value above 0 and at most 10"),
    ({"radius": None}, "--radius: needed, or --contact-radius"),
    ({"radius": "5"}, "--radius = '5': 5 is a number without a unit"),
    ({"radius": "1e-320 m"}, "sizes of real bodies"),
    ({"radius": "1e-300 m", "load": "1e-300 N"}, "--load = '1e-300 N': with these bodies"),
    ({"radius": "1e-12 m"}, "--radius = '1e-12 m': by Hertz's theory"),
    ({"counter_radius": "0 mm"}, "allowed is a radius other than 0"),
    ({"counter_radius": "-4 mm"}, "allowed is a hollow with a larger radius"),
    (
        ELASTIC | {"young": "1 MPa", "radius": "40 mm", "counter_radius": "1 mm"},
        "--counter-radius = '1 mm': by Hertz's theory",
    ),
    ({"radius_across": "1 um"}, "--radius-across = '1 um': the contact would be an ellipse of"),
    ({"radius_across": "1 mm", "counter_radius": "1 m"}, "allowed only without --counter-radius"),
    ({"contact_radius": "1 mm"}, "--radius = '5 mm': allowed only without --contact-radius"),
    ({"pressure": "hertz"}, "only without a pressure, which needs --contact-radius"),
    ({"radius": None, "pressure": "hertz"}, "--contact-radius: needed with a pressure"),
    (SIZED | {"pressure": "rong"}, "--pressure = 'rong'"),
    (SIZED | {"contact_radius": "1e-200 m"}, "--contact-radius = '1e-200 m': outside the range"),
]
BODIES = [
    ({"material": None}, "--young: needed, or a material"),
    (ELASTIC | {"nu": None}, "--nu: needed"),
    (ELASTIC | {"nu": "0.7"}, "--nu = '0.7': allowed is a finite value at least 0 and at most 0.5"),
    (ELASTIC | {"young": "inf GPa"}, "it is not finite"),
    ({"nu": "30 %"}, "--material = 'steel': allowed only without young and nu"),
    ({"material": "Steel"}, "(did you mean steel?)"),
    ({"material": "rigid"}, "allowed is an elastic body if the counterbody is rigid"),
    ({"counterbody": "wood"}, "or E and nu as in '70 GPa, 0.22'"),
    ({"counterbody": "0.22, 70 GPa"}, "its Young's modulus '0.22'"),
    ({"counterbody": "70 GPa, 0.9"}, "its Poisson's ratio '0.9': allowed is a finite value at"),
    ({"counterbody": "70 GPa, 0,22"}, "2 commas in it"),
    ({"counter_hardness": "7 GPa"}, "allowed for an elastic body, not a rigid one"),
    ({"hardness": "60 HRB"}, "the scale HRB is not supported; allowed are Vickers"),
    ({"hardness": "80 HRC"}, "allowed is 20 to 68 HRC, or a Vickers hardness"),
    ({"hardness": "200 HB"}, "about 211 HV"),  # HB = 0.95 HV, ISO 18265
    ({"hardness": "HV"}, "the text is empty"),
    ({"density": "7.85"}, "--density = '7.85': 7.85 is a number without a unit"),
]
DRIVES = [
    ({"speed": None}, "--speed: needed, or a force"),
    ({"speed": "1 mm"}, "--speed = '1 mm': the unit is mm"),
    ({"speed": "1e300 m/s", "frequency": "1e-300 Hz"}, "--speed = '1e300 m/s': divided by"),
    ({"force": "1 N"}, "--force = '1 N': allowed is a force or a speed, not both"),
    (FORCED | {"force": "0 N"}, "--force = '0 N': allowed is a finite value above 0 N"),
    (FORCED | SPRUNG, "--drive-stiffness = '1 N/um': allowed only without a force"),
    (FORCED | {"damping": "1 N*s/m"}, "--damping = '1 N*s/m': allowed only without a force"),
    ({"mass": "20 g"}, "--mass = '20 g': allowed only with a force or --drive-stiffness"),
    ({"damping": "1 N*s/m"}, "--damping = '1 N*s/m': allowed only with --drive-stiffness"),
    (SPRUNG | {"mass": "-20 g"}, "--mass = '-20 g': allowed is a finite value"),
    (SPRUNG | {"mass": "1e308 kg"}, "--mass = '1e308 kg': divided by that of the contact"),
    (SPRUNG | {"motion": "longitudinal", "speed": "0 m/s"}, "allowed is a speed above 0 for a"),
    (SPRUNG | {"motion": "continuous-bore"} | STEADY, "continuous-bore is steady"),
    ({"tolerance": "none"}, "--tolerance = 'none'"),
    ({"tolerance": "1e-9"}, "at least 1e-06 and at most 0.1"),
]
REDUCTIONS = [
    ({"reduction": "50 %"}, "--reduction = '50 %': allowed only without the amplitude"),
    (SEARCH | {"load": None}, "it determines one quantity, but amplitude and load are missing"),
    (SEARCH | {"reduction": "150 %"}, "--reduction = '150 %': allowed is a finite value above 0"),
    (SEARCH | {"reduction": "5 %"}, "allowed is at least the tolerance, 0.1"),
    (SEARCH | {"reduction": "100 %"}, "allowed is at most 90 %, 100 % minus the tolerance"),
    (SEARCH | {"motion": "bore", "reduction": "100 %"}, "allowed is less than 100 %"),
    (SEARCH | FORCED, "--reduction = '50 %': allowed only without a force"),
    (SEARCH | SPRUNG, "--reduction = '50 %': allowed only without a force"),
    (SEARCH | {"motion": "elliptic", "forward_amplitude": "1 um"}, "elliptic has several amplit"),
    (
        {"reduction": "50 %", "load": None, "amplitude": "0 m"},
        "allowed is above 0 with a reduction",
    ),
]
UNCERTAIN = [
    (
        {"mu": "0.3 +- 0.4"},
        "--mu = '0.3 +- 0.4': the uncertainty must be above 0 and at most the value",
    ),
    ({"load": "10 N +- 1 mm"}, "in it '1 mm': the unit is mm"),
    ({"load": "10 +- 1 N"}, "in it '10': 10 is a number without a unit"),
    ({"tolerance": "0.01 +- 1 %"}, "--tolerance = '0.01 +- 1 %'"),
]
OTHERS = [
    ({"load": None, "frequency": None, "radius": None}, "also missing: frequency, radius"),
    ({"diameter": "10 mm"}, "--radius is half of it"),
    ({"contact_diameter": "10 mm"}, "--contact-radius is half of it"),
    ({"output": "found.nc"}, "--output = 'found.nc': allowed only with --table"),
]
PREDICTIONS = OTHERS + MOTIONS + CONTACTS + BODIES + DRIVES + REDUCTIONS + UNCERTAIN
