"""Bad command lines of microslip, each with parts that its one line on standard error must have.

The option at fault, the value as it was given, and what is allowed.
"""

TRANSVERSE = "point transverse --velocity 0.5 --amplitude 0.5"
BORE = "point bore --velocity 0.5 --amplitude 0.5"
STEADY = "point continuous-bore --velocity 0.5"

FINITE = "a finite number of at least 0"
RATIO = "at least 0 and at most 0.5"
RANGE = "at least 1e-06 and at most 0.1"

# Arguments to what was right: of an option given twice the later value counts.
NUMBERS = [
    (f"{TRANSVERSE} --velocity -1", "--velocity = '-1'", FINITE),
    (f"{TRANSVERSE} --velocity -1e-3", "--velocity = '-1e-3'", FINITE),
    (f"{TRANSVERSE} --velocity=-1e-3", "--velocity = '-1e-3'", FINITE),
    (f"{TRANSVERSE} --velocity nan", "--velocity = 'nan'", FINITE),
    (f"{TRANSVERSE} --velocity inf", "--velocity = 'inf'", FINITE),
    (f"{TRANSVERSE} --velocity -inf", "--velocity = '-inf'", FINITE),
    (f"{TRANSVERSE} --velocity 1e7", "--velocity = '1e7'", "at most 1e+06"),
    (f"{TRANSVERSE} --velocity fast", "--velocity = 'fast'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity 0,5", "--velocity = '0,5'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity 0.1:1", "--velocity = '0.1:1'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity ''", "--velocity = ''", "allowed is a number"),
    (f"{TRANSVERSE} --velocity '1\n2'", r"--velocity = '1\n2'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity", "--velocity", "expected one argument"),
    (f"{BORE} --amplitude -0.5", "--amplitude = '-0.5'", FINITE),
    (f"{BORE} --amplitude NaN", "--amplitude = 'NaN'", FINITE),
    (f"{BORE} --amplitude 1e999", "--amplitude = '1e999'", FINITE),
    (f"{BORE} --amplitude 1e300", "--amplitude = '1e300'", "at most 1e+06"),
    (f"{BORE} --amplitude 30deg", "--amplitude = '30deg'", "allowed is a number"),
    (f"{TRANSVERSE} --poisson 0.7", "--poisson = '0.7'", RATIO),
    (f"{TRANSVERSE} --poisson 0.5000001", "--poisson = '0.5000001'", RATIO),
    (f"{BORE} --poisson -0.1", "--poisson = '-0.1'", RATIO),
    (f"{STEADY} --poisson nan", "--poisson = 'nan'", RATIO),
    (f"{TRANSVERSE} --poisson steel", "--poisson = 'steel'", "allowed is a number"),
    (f"{TRANSVERSE} --tolerance 0", "--tolerance = '0'", RANGE),
    (f"{TRANSVERSE} --tolerance 1", "--tolerance = '1'", RANGE),
    (f"{TRANSVERSE} --tolerance 1e-9", "--tolerance = '1e-9'", RANGE),
    (f"{TRANSVERSE} --tolerance -1e-3", "--tolerance = '-1e-3'", RANGE),
    (f"{STEADY} --tolerance nan", "--tolerance = 'nan'", RANGE),
    (f"{STEADY} --tolerance 1%", "--tolerance = '1%'", "allowed is a number"),
    (f"{TRANSVERSE} --cells 7", "--cells = '7'", "an even number"),
    (f"{TRANSVERSE} --cells 2", "--cells = '2'", "at least 4"),
    (f"{TRANSVERSE} --cells 0", "--cells = '0'", "at least 4"),
    (f"{TRANSVERSE} --cells -8", "--cells = '-8'", "at least 4"),
    (f"{TRANSVERSE} --cells 1002", "--cells = '1002'", "at most 1000"),
    (f"{TRANSVERSE} --cells 8.5", "--cells = '8.5'", "a whole number"),
    (f"{TRANSVERSE} --cells 1e3", "--cells = '1e3'", "a whole number"),
    (f"{TRANSVERSE} --steps 9", "--steps = '9'", "an even number"),
    (f"{TRANSVERSE} --steps 6", "--steps = '6'", "at least 8"),
    (f"{TRANSVERSE} --steps 2000000", "--steps = '2000000'", "at most 1e+06"),
    (f"{TRANSVERSE} --steps many", "--steps = 'many'", "a whole number"),
    (f"{TRANSVERSE} --time-limit 0", "--time-limit = '0'", "a number above 0"),
    (f"{TRANSVERSE} --time-limit nan", "--time-limit = 'nan'", "a number above 0"),
    (f"{TRANSVERSE} --time-limit 5s", "--time-limit = '5s'", "a number"),
]

MINUS, ARABIC_THREE, WIDE_ONE = "\N{MINUS SIGN}", "\N{ARABIC-INDIC DIGIT THREE}", "\uff11"

# What Python's float takes and people do not mean, and what people mean and it does not take.
GRAMMAR = [
    (f"{TRANSVERSE} --velocity {MINUS}1", f"--velocity = '{MINUS}1'", FINITE),
    (f"{TRANSVERSE} --velocity -1,5", "--velocity = '-1,5'", "with a point: -1.5"),
    (f"{TRANSVERSE} --velocity 0,5", "--velocity = '0,5'", "with a point: 0.5"),
    (f"{TRANSVERSE} --velocity 1,000.5", "--velocity = '1,000.5'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity 1_000", "--velocity = '1_000'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity {ARABIC_THREE}", f"'{ARABIC_THREE}'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity {WIDE_ONE}", f"'{WIDE_ONE}'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity 0x1", "--velocity = '0x1'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity 1d-3", "--velocity = '1d-3'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity 1/2", "--velocity = '1/2'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity '1 2'", "--velocity = '1 2'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity '- 1'", "--velocity = '- 1'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity --1", "unknown option --1;", "allowed: --help"),
    (f"{TRANSVERSE} --velocity 1e400", "--velocity = '1e400'", "at most 1e+06"),
    (f"{TRANSVERSE} --velocity -infinity", "--velocity = '-infinity'", FINITE),
    (f"{TRANSVERSE} --velocity .", "--velocity = '.'", "allowed is a number"),
    (f"{TRANSVERSE} --velocity e5", "--velocity = 'e5'", "allowed is a number"),
    (f"{TRANSVERSE} --tolerance 1e-3\N{EN SPACE}1", "1'", "allowed is a number"),
    (f"{TRANSVERSE} --nu 0.7", "--nu = '0.7'", RATIO),
    (f"{TRANSVERSE} --nu=steel", "--nu = 'steel'", "allowed is a number"),
    (f"{TRANSVERSE} --poisson 0.1 --nu 0,3", "--nu = '0,3'", "with a point: 0.3"),
    (f"{TRANSVERSE} --cells 1_0", "--cells = '1_0'", "a whole number"),
    (f"{TRANSVERSE} --cells 16.0", "--cells = '16.0'", "a whole number"),
    (f"{TRANSVERSE} --cells {ARABIC_THREE}2", f"'{ARABIC_THREE}2'", "a whole number"),
    (f"{TRANSVERSE} --cells {'9' * 5000}", "--cells = '999", "a whole number"),
    (f"{TRANSVERSE} --steps {MINUS}8", f"--steps = '{MINUS}8'", "at least 8"),
    ("point elliptic --velocity 1 --amplitude 1 --path phase=1_0", "--path", "elliptic:key=0.5"),
    ("point elliptic --velocity 1 --amplitude 1 --path forward=2", "--path = 'forward=2'", "0..1"),
    ("point elliptic --velocity 1 --amplitude 1 --path phas=2", "--path = 'phas=2'", "phas;"),
    (f"{TRANSVERSE} --pressure power:exponent=1_0", "'power:exponent=1_0'", "power:key=0.5"),
]

NAMES = [
    (f"{TRANSVERSE} --pressure cone", "--pressure = 'cone'", "allowed is one of hertz"),
    (f"{TRANSVERSE} --pressure power:exponent=0.5", "exponent = 0.5", "allowed is a number in 1.."),
    (f"{TRANSVERSE} --pressure ellipse --model radial", "--model = 'radial'", "rings cannot"),
    (f"{TRANSVERSE} --model best", "--model = 'best'", "auto, rigid, slider"),
    (f"{TRANSVERSE} --model Polar", "--model = 'Polar'", "polar"),
    (f"{TRANSVERSE} --model ''", "--model = ''", "auto, rigid, slider"),
    (f"{TRANSVERSE} --model radial --poisson 0.3", "--model = 'radial'", "transverse", "nu"),
    (f"{BORE} --model radial", "--model = 'radial'", "does not apply to bore", "rotation"),
    (f"{BORE} --model slider", "--model = 'slider'", "does not apply to bore"),
    (f"{STEADY} --model mdr", "--model = 'mdr'", "does not apply to continuous-bore"),
    (f"{TRANSVERSE} --method shiped", "--method = 'shiped'", "did you mean shipped?", "admm,"),
    (f"{TRANSVERSE} --method full_newton", "'full_newton'", "did you mean full-newton?"),
    (f"{TRANSVERSE} --method ../euler", "--method = '../euler'", "allowed is one of shipped,"),
    (f"{TRANSVERSE} --method admm:", "--method = 'admm:'", "admm:key=0.5"),
    (f"{TRANSVERSE} --method admm:penalty", "'admm:penalty'", "admm:key=0.5"),
    (f"{TRANSVERSE} --method admm:penalty=high", "'admm:penalty=high'", "admm:key=0.5"),
    (f"{TRANSVERSE} --method admm:penalty=nan", "'admm:penalty=nan'", "admm:key=0.5"),
    (f"{TRANSVERSE} --method admm:penalt=1", "penalt;", "allowed: penalty, relaxation"),
    (f"{TRANSVERSE} --method admm:penalty=1,penalty=2", "penalty occurs twice", "once"),
    (f"{TRANSVERSE} --method shipped:order=2", "unknown number order", "allowed: none"),
    (f"{TRANSVERSE} --method paper", "--method = 'paper'", "model cartesian"),
    (f"{STEADY} --method march", "--method = 'march'", "continuous-bore", "nothing oscillates"),
    (f"{BORE} --model rigid --method euler", "--method = 'euler'", "bore, model rigid"),
]

OPTIONS = [
    ("", "COMMAND is missing", "allowed: point, sweep, gc, predict"),
    ("solve", "COMMAND = 'solve'", "point, sweep, gc, predict"),
    ("pont", "COMMAND = 'pont'", "did you mean point?"),
    ("--json", "--json", "COMMAND before other options"),
    ("point --poisson 0.3", "--poisson", "SCENE before other options"),
    ("--verion", "--verion", "did you mean --version?"),
    ("--velocity 1 point transverse", "--velocity", "COMMAND before other options"),
    ("point", "SCENE is missing", "transverse, longitudinal, zigzag, bore, continuous-bore,"),
    ("point bores --velocity 1", "SCENE = 'bores'", "did you mean bore?"),
    ("point transverse --speed 1 --amplitude 1", "option --speed;", "did you mean --velocity?"),
    ("point transverse -speed=1 --amplitude 1", "option -speed;", "did you mean --velocity?"),
    ("predict transverse --velocity 1", "option --velocity;", "did you mean --speed?"),
    ("point sideways --velocity 1", "SCENE", "'sideways'", "zigzag"),
    ("point continuous_bore --velocity 1", "'continuous_bore'", "continuous-bore"),
    ("point --velocity 1 transverse", "--velocity", "SCENE before other options"),
    ("point transverse --amplitude 1", "required: --velocity"),
    ("point transverse --velocity 1", "required: --amplitude"),
    ("point bore", "required: --velocity, --amplitude"),
    (f"{STEADY} --amplitude 1", "unknown option --amplitude", "allowed: --help, --velocity"),
    ("point bore --velo 1 --amplitude 1", "option --velo;", "did you mean --velocity?"),
    ("point bore --vleocity=1 --amplitude 1", "option --vleocity;", "did you mean --velocity?"),
    ("point bore -velocity 1 --amplitude 1", "option -velocity;", "did you mean --velocity?"),
    (f"{TRANSVERSE} --step 8", "unknown option --step;", "did you mean --steps?"),
    (f"{TRANSVERSE} --colour red", "unknown option --colour;", "allowed: --help"),
    (f"{TRANSVERSE} '--a\nb'", "unknown option --a b;", "allowed: --help"),
    (f"{TRANSVERSE} -q", "unknown option -q;", "allowed: --help"),
    (f"{TRANSVERSE} --json=yes", "--json", "'yes'"),
    (f"{TRANSVERSE} bore", "unrecognized arguments: bore"),
    (f"{TRANSVERSE} 0.5", "unrecognized arguments: 0.5"),
]

# Of these the folder is as tests/config/test_bad_input.py makes it.
RESULTS = [
    (f"{TRANSVERSE} --results", "--results", "expected one argument"),
    (f"{TRANSVERSE} --results ''", "--results: ''", "the name of a folder"),
    (f"{TRANSVERSE} --results ' '", "--results: ' '", "the name of a folder"),
    (f"{TRANSVERSE} --results a-file", "--results", "a-file", "Not a directory", "another folder"),
    (f"{TRANSVERSE} --results a-file/deep", "--results", "a-file/deep", "Not a directory"),
    (f"{TRANSVERSE} --results lost-link", "--results", "lost-link", "another folder"),
    (f"{TRANSVERSE} --results /proc/none", "--results", "/proc/none", "another folder"),
    (f"{TRANSVERSE} --results {'x' * 300}", "--results", "xxx", "File name too long"),
    (f"{TRANSVERSE} --results kept --method admm", "--method = 'admm'", "shipped with --results"),
    (f"{TRANSVERSE} --results kept --poisson 0.7", "--poisson = '0.7'", RATIO),
    (f"{TRANSVERSE} --results kept --velocity nan", "--velocity = 'nan'", FINITE),
    (f"{TRANSVERSE} --results kept --cells 7", "--cells = '7'", "an even number"),
    (f"{BORE} --results kept --model slider", "--model = 'slider'", "does not apply to bore"),
]

COMMAND_LINES = [*NUMBERS, *GRAMMAR, *NAMES, *OPTIONS, *RESULTS]
