"""Bad command lines of microslip, each with parts of the line on standard error.

The parts are the option, its value, and the allowed values.
"""

TRANSVERSE = "point transverse --velocity 0.5 --amplitude 0.5"
BORE = "point bore --velocity 0.5 --amplitude 0.5"
STEADY = "point continuous-bore --velocity 0.5"
SHAKEN = "point transverse --amplitude 0.5"
GRADIENT = "projected-gradient"
SPUN = "point bore --velocity 0.5"
PREDICTED = (
    "predict transverse --young '210 GPa' --radius '5 mm' --load '10 N' --mu 0.3 "
    "--speed '1 mm/s' --amplitude '1 um' --frequency '20 kHz'"
)

FINITE = "a finite number of at least 0"
RATIO = "at least 0 and at most 0.5"
RANGE = "at least 1e-06 and at most 0.1"
NEARER_0 = "nearer 0 than floating-point numbers can be; allowed is 0 or a number further from it"
BEYOND = "beyond the range of floating-point numbers; allowed is a number within it"

# Arguments added to a valid command, or to one with only a velocity, force or amplitude.
NUMBERS = [
    (f"{SHAKEN} --velocity -1", "--velocity = '-1'", FINITE),
    (f"{SHAKEN} --velocity -1e-3", "--velocity = '-1e-3'", FINITE),
    (f"{SHAKEN} --velocity 1e7", "--velocity = '1e7'", "at most 1e+06"),
    (f"{SHAKEN} --velocity '1\n2'", r"--velocity = '1\n2'", "allowed is a number"),
    (f"{SHAKEN} --velocity", "--velocity", "expected one argument"),
    (f"{SPUN} --amplitude -0.5", "--amplitude = '-0.5'", FINITE),
    (f"{SPUN} --amplitude 1e999", "--amplitude = '1e999'", BEYOND),
    (f"{SHAKEN} --force -0.1", "--force = '-0.1'", "at least 0: transverse propels nothing"),
    (f"{TRANSVERSE} --force 0.1", "--force = '0.1'", "a force or a velocity, not both"),
    (f"{SHAKEN} --force 0.1 --stiffness 1", "--stiffness = '1'", "none beside a force"),
    (f"{SHAKEN} --force 0.1 --damping 1", "--damping = '1'", "none beside a force"),
    ("point elliptic:forward --velocity 1 --amplitude 1", "MOTION", "in it 'forward'"),
    (f"{SHAKEN} --force 0.1 --model rigid", "--model = 'rigid'", "supports no force"),
    (f"{SHAKEN} --force 0.1 --method march", "--method = 'march'", "shipped with a force"),
    (f"{TRANSVERSE} --stiffness 1e7", "--stiffness = '1e7'", "at most 1e+06"),
    (f"{TRANSVERSE} --stiffness 1 --mass inf", "--mass = 'inf'", FINITE),
    (f"{TRANSVERSE} --stiffness 1 --damping -1", "--damping = '-1'", FINITE),
    (f"{TRANSVERSE} --mass 1", "--mass = '1'", "beside a stiffness alone"),
    (f"{TRANSVERSE} --damping 1", "--damping = '1'", "beside a stiffness alone"),
    (f"{TRANSVERSE} --poisson 0.7", "--poisson = '0.7'", RATIO),
    (f"{TRANSVERSE} --tolerance 0", "--tolerance = '0'", RANGE),
    (f"{TRANSVERSE} --cells 7", "--cells = '7'", "an even number"),
    (f"{TRANSVERSE} --cells 1002", "--cells = '1002'", "at most 1000"),
    (f"{TRANSVERSE} --cells 8.5", "--cells = '8.5'", "a whole number"),
    (f"{TRANSVERSE} --steps 9", "--steps = '9'", "an even number"),
    (f"{TRANSVERSE} --time-limit 0", "--time-limit = '0'", "a number above 0"),
    (f"{TRANSVERSE} --time-limit 5s", "--time-limit = '5s'", "a number"),
]

MINUS = "\N{MINUS SIGN}"

# Forms of numbers; tests/foundation/test_spec.py has more.
GRAMMAR = [
    (f"{SHAKEN} --velocity {MINUS}1", f"--velocity = '{MINUS}1'", FINITE),
    (f"{SHAKEN} --velocity -1,5", "--velocity = '-1,5'", "with a point: -1.5"),
    (f"{SHAKEN} --velocity 0,5", "--velocity = '0,5'", "with a point: 0.5"),
    (f"{SHAKEN} --velocity 1e400", "--velocity = '1e400'", BEYOND),
    ("point elliptic:forward=2 --velocity 1 --amplitude 1", "'elliptic:forward=2'", "0..1"),
    ("point elliptic:phas=2 --velocity 1 --amplitude 1", "'elliptic:phas=2'", "phas;"),
    (f"{TRANSVERSE} --pressure power:exponent=1_0", "'power:exponent=1_0'", "power:key=0.5"),
]

# Python's float returns 0 or infinity.
OUT_OF_RANGE = [
    (f"{SHAKEN} --velocity 1e-400", "--velocity = '1e-400'", NEARER_0),
    (f"{TRANSVERSE} --time-limit 1e400", "--time-limit = '1e400'", BEYOND),
    (f"{TRANSVERSE} --pressure power:exponent=1e400", "'exponent=1e400'", BEYOND, "power:key=0.5"),
    (f"{PREDICTED} --nu 0 --tolerance 1e-400", "--tolerance = '1e-400'", "below the range"),
]

# argparse takes the last of two values.
TWICE = [
    (f"{TRANSVERSE} --velocity 0.2", "--velocity is given twice; allowed: once"),
    (f"{TRANSVERSE} --velocity -0.2", "--velocity is given twice; allowed: once"),
    (f"{TRANSVERSE} --poisson 0.1 --nu=0.2", "--nu is given twice, as --poisson the first time;"),
    (f"{PREDICTED} --speed '-1 mm/s'", "--speed is given twice; allowed: once"),
]

NAMES = [
    (f"{TRANSVERSE} --pressure cone", "--pressure = 'cone'", "allowed is one of hertz"),
    (f"{TRANSVERSE} --pressure power:exponent=0.5", "exponent = 0.5", "allowed is a number in 1.."),
    (f"{TRANSVERSE} --pressure ellipse --model radial", "--model = 'radial'", "rings cannot"),
    (f"{TRANSVERSE} --model best", "--model = 'best'", "auto, rigid, slider"),
    (f"{TRANSVERSE} --model radial --poisson 0.3", "--model = 'radial'", "transverse", "nu"),
    (f"{BORE} --model radial", "--model = 'radial'", "does not apply to bore", "rotation"),
    (f"{BORE} --model slider", "--model = 'slider'", "does not apply to bore"),
    (
        f"{TRANSVERSE} --method shiped",
        "--method = 'shiped'",
        "did you mean shipped?",
        "march,",
    ),
    (f"{TRANSVERSE} --method ../euler", "--method = '../euler'", "allowed is one of shipped,"),
    (
        f"{TRANSVERSE} --method projected-gradient:step=high",
        "'projected-gradient:step=high'",
        "projected-gradient:key=0.5",
    ),
    (f"{TRANSVERSE} --method {GRADIENT}:stap=1", "stap;", "allowed: step"),
    (f"{TRANSVERSE} --method {GRADIENT}:step=1,step=2", "step occurs twice", "once"),
    (f"{TRANSVERSE} --method paper", "--method = 'paper'", "model cartesian"),
    (f"{STEADY} --method march", "--method = 'march'", "continuous-bore", "nothing oscillates"),
    (f"{BORE} --model rigid --method euler", "--method = 'euler'", "bore, model rigid"),
]

OPTIONS = [
    ("", "COMMAND is missing", "allowed: point, predict, fit, response"),
    ("pont", "COMMAND = 'pont'", "did you mean point?"),
    ("export", "COMMAND = 'export'", "export iwan, export table"),
    ("--json", "unknown option --json;", "allowed: --help, --version"),
    ("point --poisson 0.3", "required: MOTION"),
    ("point bores --velocity 1", "MOTION = 'bores'", "did you mean bore?"),
    ("point transverse --speed 1 --amplitude 1", "option --speed;", "did you mean --velocity?"),
    ("predict transverse --velocity 1", "option --velocity;", "did you mean --speed?"),
    ("point transverse --amplitude 1", "--velocity: needed;", "or a force in its place"),
    ("point transverse --velocity 1", "--amplitude: transverse needs an amplitude"),
    (f"{STEADY} --amplitude 1", "--amplitude = '1'", "continuous-bore has no amplitude"),
    (f"{TRANSVERSE} --step 8", "unknown option --step;", "did you mean --steps?"),
    (f"{TRANSVERSE} '--a\nb'", "unknown option --a b;", "allowed: --help"),
    (f"{TRANSVERSE} bore", "unrecognized arguments: bore"),
    (f"{PREDICTED} mm", "unrecognized arguments: mm", "allowed: options, each with one value"),
    (f"{PREDICTED} --nu 0.3 --radius-across '1 um'", "--radius-across = '1 um'", "of ratio"),
    ("fit transverse a-file --map m.csv", "--map = 'm.csv'", "a path that ends in .nc"),
    ("fit transverse a-file --map nosuch.nc", "--map = 'nosuch.nc': nosuch.nc is not there"),
    ("fit transverse a-file --output fit.csv", "--output = 'fit.csv'", "ends in .nc"),
    ("fit transverse a-file --figure fit.jpg", "--figure = 'fit.jpg'", "ends in .png or .pdf"),
    ("fit transverse a-file --mu 0.3", "unknown option --mu;"),
    ("fold a-file", "--output: needed"),
    ("response a-file --output none/a.csv", "--output = 'none/a.csv'", "a folder that can be"),
    ("export iwan --material steel", "--mu: needed; also missing: load, radius"),
    ("export iwan --elements 2.5", "--elements = '2.5'", "whole number"),
]

COMMAND_LINES = [*NUMBERS, *GRAMMAR, *OUT_OF_RANGE, *TWICE, *NAMES, *OPTIONS]
