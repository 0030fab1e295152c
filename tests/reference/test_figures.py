"""Systems of the book: final values computed independently with the same rule and step (models.md, marked F)."""

from __future__ import annotations

import pytest

from tests.reference.runs import run, value

SYSTEMS = {
    "car with drag": (
        ("TMAX = 20 | DT = 0.05 | NN = 201 | F = 4000 | alpha = 1 | m = 1000\ndrun\nDYNAMIC\n"
        "drag = alpha*v^2\nd/dt s = v\nd/dt v = (F - drag)/m"),
        {"v": 53.91122106, "s": 648.4224402},
    ),
    "step response": (
        ("TMAX = 0.5 | DT = 1e-4 | NN = 1001 | ww = 400 | u = 440 | r = 10\ndrun\nDYNAMIC\n"
        "d/dt x = xdot\nd/dt xdot = -ww*x - r*xdot + u"),
        {"x": 1.193253129},
    ),
    "van der Pol": (
        ("TMAX = 13 | DT = 0.0035 | NN = 3000 | A = 2.2 | x = 0.5\ndrun\nDYNAMIC\n"
        "d/dt x = xdot\nd/dt xdot = -x + A*(1 - x^2)*xdot"),
        {"t": 13.0025, "x": 1.959830388, "xdot": 0.7880361988},
    ),
    "pitch plane": (
        ("TMAX = 20 | DT = 0.005 | NN = 2000 | MM = 4 | w = 0.6 | B = 0.16\ndrun\nDYNAMIC\n"
        "e = B*sgn(sin(w*t))\ngam = phi - theta\nd/dt theta = gam - 0.1*e\nd/dt phi = q\n"
        "d/dt q = -10*gam - 0.5*q + 10*e"),
        {"theta": 0.1516357383, "phi": 0.007516949163, "q": -0.1629158571},
    ),
    "phugoid": (
        ("TMAX = 20 | DT = 0.01 | NN = 1001 | V = 1.5\ndrun\nDYNAMIC\n"
        "d/dt V = -sin(g) - 0.02*V^2\nd/dt g = (V^2 - cos(g))/V\nd/dt x = V*cos(g)\nd/dt y = V*sin(g)"),
        {"V": 0.6897886178, "g": 0.05942121568},
    ),
    "epidemic": (
        ("TMAX = 50 | DT = 0.02 | NN = 1001 | A = 0.001 | B = 0.07 | C = 0.01 | s = 620 | i = 10 | c = 70\n"
        "drun\nDYNAMIC\nd/dt s = -A*s*i\nd/dt i = (A*s - B - C)*i\nd/dt c = B*i"),
        {"s": 0.3127957086, "i": 22.33029044},
    ),
    "host and parasite": (
        ("TMAX = 250 | DT = 0.01 | NN = 500 | k1 = 0.05 | k2 = 0.1 | k3 = 2e-4 | k4 = 2e-4 | h = 100 | p = 200\n"
        "drun\nDYNAMIC\nd/dt h = (k1 - k4*p)*h\nd/dt p = (-k2 + k3*h)*p"),
        {"h": 338.177486, "p": 22.27160344},
    ),
    "difference equation": (
        "NN = 50 | x = 10\ndrun\nDYNAMIC\nx = x + 0.1*x*(1 - x/1000)",
        {"x": 561.0466332},
    ),
    "chaos map": (
        ("NN = 10 | m = -0.495 | a = 0.005 | b = 0.05 | x = 0.5 | y = 0.5\n"
        "FUNCTION g(q$) = m*q$ + 2*(1 - m)*q$^2/(q$^2 + 1)\ndrun\nDYNAMIC\n"
        "X = y + a*(1 - b*y^2)*y + g(x)\nY = -x + g(X)\nx = X\ny = Y"),
        {"x": 0.1959530816, "y": -0.07148360622},
    ),
    "digital controller": (
        ("TMAX = 2.5 | DT = 0.001 | NN = 700 | R = 3 | mt = 0.8 | TS = 0.05 | u = 0.7\n"
        "KP = 3 | KI = 1.2 | KD = 0.2 | B0 = KD/TS | B1 = -KP + 0.5*KI*TS - 2*KD/TS | B2 = KP + 0.5*KI*TS + KD/TS\n"
        "x1 = 0 | x2 = 0 | y = 0\ndrun\nDYNAMIC\ntorque = mt*tanh(y/mt)\nd/dt x = xdot\n"
        "d/dt xdot = 10*torque - R*xdot\nSAMPLE TS*(NN - 1)/TMAX\ne = x - u\n"
        "y = B0*x1 + B1*x2 + B2*(x2 - e)\nx1 = x2\nx2 = x2 - e"),
        {"x": 0.7400371556, "xdot": -0.05637322904},
    ),
    "limited integrator": (
        ("TMAX = 6 | DT = 0.001 | NN = 601\nFUNCTION lt(p$) = swtch(p$)\ndrun\nDYNAMIC\nu = cos(t)\n"
        "free = 1 - (1 - swtch(0.5 - x))*lt(u) - (1 - swtch(x + 0.5))*lt(-u)\nd/dt x = u*free"),
        {"x": 0.220524605},
    ),
    "relay oscillator and track/hold": (
        ("TMAX = 15 | DT = 0.001 | NN = 10000 | u = 4 | w = 6 | x = 1 | p = 1\ndrun\nDYNAMIC\n"
        "d/dt u = 0.5*v\nd/dt v = -0.5*u\nd/dt x = w*p\nstep\np = sgn(p - x)\nU = U + swtch(p)*(u - U)"),
        {"u": 1.386540099, "x": -0.416, "U": 1.8239495, "p": -1},
    ),
    "satellite roll control": (
        ("TMAX = 4 | DT = 0.0025 | NN = 1000 | ARRAY D[1000]\nOm = 94.24478 | ze = 0.7 | THC = 0.09 | D1 = 0.008\n"
        "TD = 0.025 | TC = 0.05 | I = 100 | KR = 0.5 | FM = 25 | FD = 12.1875 | er = 0\nSUBMODEL sensor(s$, sp$, z$)\n"
        "d/dt s$ = sp$\nd/dt sp$ = -2*ze*Om*sp$ + Om^2*(z$ - s$)\nend\ndrun\nDYNAMIC\n"
        "sensor(a, ap, theta)\nsensor(b, bp, thdot)\nethet = THC - (a + KR*b)\ntdelay u = D(er, TD\n"
        "d/dt f = -f/TC + (FM/TC)*u\nd/dt theta = thdot\nd/dt thdot = (f + FD)/I\nstep\n"
        "er = deadc(ethet/D1 - 0.01*er)"),
        {"theta": 0.09812897667, "thdot": -0.008017033458, "f": -8.965933084},
    ),
    "programmed step": (
        ("irule 5 | TMAX = 2 | NN = 10000 | u = 0.1 | volt = 0\ndrun\nDYNAMIC\nerr = x - u\nd/dt V = -40*V + 10000*volt\n"
        "torque = tanh(V)\nd/dt x = xdot\nd/dt xdot = torque - 0.6*xdot\nstep\nDT = 2e-4*SAT(abs(100*err)) + 2e-5\n"
        "volt = -sgn(40*err + 2.5*xdot - 0.01*volt)"),
        {"V": 139.7300548, "x": 0.09982690995, "xdot": 0.001888756093},
    ),
    "inventory, Euler": (
        ("irule 2 | TMAX = 60 | DT = 0.25 | NN = 241 | I = 200 | W = 20\ndrun\nDYNAMIC\n"
        "d = 100 + 20*(1 - swtch(5 - t))\nd/dt I = 5*W - d\nd/dt W = ((d + (200 - I)/4)/5 - W)/10"),
        {"I": 191.3687554, "W": 24.22657471},
    ),
    "stiff system, RK4": (
        "irule 3 | TMAX = 10 | DT = 0.0025 | NN = 100 | x = 1\ndrun\nDYNAMIC\nd/dt x = y\nd/dt y = -100*x - 101*y",
        {"x": 4.585851491e-05},
    ),
    "five oscillators at once": (
        ("TMAX = 0.5 | DT = 1e-4 | NN = 1001 | ww = 400 | u = 440 | STATE x[5], xdot[5] | ARRAY r[5]\n"
        "for i = 1 to 5 | r[i] = 10*i | next\ndrun\nx1 = x[1] | x3 = x[3] | x5 = x[5]\nDYNAMIC\n"
        "Vectr d/dt x = xdot\nVectr d/dt xdot = -ww*x - r*xdot + u"),
        {"x1": 1.193253129, "x3": 1.099200355, "x5": 1.09011767},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SYSTEMS)
def test_figure(name):
    text, expected = SYSTEMS[name]
    session = run(text)
    for variable, number in expected.items():
        assert value(session, variable) == pytest.approx(number, rel=1e-8), variable
