"""`desire convert`: what goes where, what is said, with which status."""

from __future__ import annotations

from pathlib import Path

import pytest

import desire_tui
from desire_tui.convert.conversion import convert
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.source import Source
from tests.batch.command_line import desire

ODE = Path(__file__).parent / "ode"


def of(text: str):
    return convert(Source(text, "model.ode"))


def said(text: str) -> list[tuple[int, int | None, str]]:
    return [(problem.code, problem.line, problem.message) for problem in of(text).problems]


def test_a_converted_program_runs_and_writes_its_samples(tmp_path):
    target = tmp_path / "swing.src"
    status, out, err = desire("convert", str(ODE / "pendulum.ode"), "-o", str(target))
    assert (status, out) == (0, "")
    assert "562: 'P.E.' is called 'P_E' here" in err
    status, out, _ = desire("run", str(target), "--csv", "-")
    assert status == 0
    assert out.splitlines()[0] == "run,t,x,xp,P_E,K_E,T_E"
    assert len(out.splitlines()) == 2002


def test_the_program_goes_to_standard_output_and_carries_the_comments():
    status, out, err = desire("convert", str(ODE / "morris_lecar.ode"))
    assert status == 0
    lines = out.splitlines()
    assert lines[:2] == [
        "-- morris_lecar -- converted from morris_lecar.ode (XPPAUT)",
        "-- Morris and Lecar (1981), as in Rinzel and Ermentrout",
    ]
    assert lines[lines.index("-- the membrane") + 1] == "d/dt v = gl*(vl - v) + gk*w*(vk - v) - icaf + i"
    assert "morris_lecar.ode:19:1: warning 561: b v-v': boundary values are not fitted here" in err


def test_what_is_missing_keeps_a_program_back_unless_it_is_asked_for(tmp_path):
    file = tmp_path / "volterra.ode"
    file.write_text("x'=-x\nu(t)=int{exp(-t)#x}\ndone\n")
    status, out, err = desire("convert", str(file))
    assert (status, out) == (1, "")
    assert "volterra.ode:2:1: error 560: 'u(t)=int{exp(-t)#x}' is not converted" in err
    status, out, err = desire("convert", str(file), "--partial")
    assert status == 1
    assert "-- ! line 2: 'u(t)=int{exp(-t)#x}' is not converted" in out
    assert desire_tui.run(out + "\n").error is None


def test_files_that_are_no_models(tmp_path):
    for name, text in (("model.txt", "x'=-x\n"), ("model.src", "x = 1\n")):
        (tmp_path / name).write_text(text)
        status, out, err = desire("convert", str(tmp_path / name))
        assert (status, out) == (1, "")
        assert "error 563" in err
    status, _, err = desire("convert", str(tmp_path / "none.ode"))
    assert status == 1
    assert "error 38" in err


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("y'=x+", "'x+' ends too early"),
        ("y'=(x", "'(x' has the end where ')' was expected"),
        ("y'=x)", "'x)' does not end before ')'"),
        ("y'=x$2", "'x$2' cannot be read at '$'"),
        ("y'=z", "'z' is declared nowhere"),
        ("y'=f(x)", "there is no function 'f'"),
        ("y'=x(2)", "there is no function 'x'"),
        ("x(a)=a", "'x' is a quantity already"),
        ("g(1a)=1", "its arguments are no names"),
        ("y'=erf(x)", "Desire has no error function"),
        ("y'=sin(x,x)", "'sin' takes 1 argument(s)"),
        ("y'=if(x)then(1)", "'if(x)then(1)': 'if' needs 'then' and 'else'"),
        ("y'=x'", "'x'' means something in boundary conditions only"),
        ("y'=sum(0,x)of(i')", "an index or a bound of a sum must be a constant"),
        ("y'=sum(0,9999)of(i')", "the sum has 10000 terms, more than 2000"),
        ("y'=shift(x,7)", "there is no quantity +7 places from 'x'"),
        ("x'=1", "'x' has an equation already"),
        ("exp=2*x", "'exp' is a word of XPPAUT's"),
        ("y'=delay(x)", "'delay' takes a variable and a time"),
        ("special k=fconv(even,5,1,w,x,x,f)", "this network function has no counterpart here"),
        ("special k=conv(even,1,0,w,x)", "'w' is no table"),
        ("special k=conv(even,1,0)", "'conv' has other arguments"),
        ("0=x-1", "algebraic equations are not solved here"),
        ("solve y=1", "algebraic equations are not solved here"),
        ("export {x} {y}", "functions of a library are not called here"),
        ("nonsense", "it is no declaration of XPPAUT's"),
        ("par a 1", "it is no list of name=value"),
        ("global x-1", "it is no `global sign {condition} {name=formula;…}`"),
        ("global 1 x-1 {z=0}", "'z=0' assigns to nothing that is declared"),
        ("markov m 2", "4 rates in braces should follow, there are 0"),
        ("table w nothing.tab", "there is no file nothing.tab"),
        ("table w % 1 0 1 t", "a table has 2 to 100000 points over a rising range"),
        ("#include nothing.ode", "there is no file nothing.ode"),
        ("z[1..30000]'=0", "it stands for 30000 lines, more than 20000"),
        ("%[1..3]", "no % ends the block"),
        ("aux z", "it is no name=formula"),
    ],
)
def test_what_cannot_be_converted_is_named_with_its_line_and_the_reason(line, reason):
    errors = [entry for entry in said(f"x'=-x\n\n{line}\n") if entry[0] == 560]
    assert [entry[1] for entry in errors] == [3]
    assert errors[0][2].endswith(f"is not converted: {reason}")


def test_a_network_whose_table_is_not_converted():
    errors = said("x'=k(0)\ntable w none.tab\nspecial k=conv(even,1,0,w,x)\n")
    assert [(code, line) for code, line, _ in errors] == [(560, 2), (560, 3)]


def test_quantities_that_wait_for_each_other():
    assert "these wait for each other: a → b → a" in said("x'=a\na=b\nb=a\n")[0][2]
    with pytest.raises(DesireError) as error:
        of("x'=a\n!a=b\n!b=a\n")
    assert "these wait for each other: a → b → a" in error.value.message


def test_options_without_a_meaning_are_listed_and_methods_told():
    assert said("x'=-x\n@ total=5,maxstor=9,meth=cvode,axes=3\n@ meth=nonsense,dt=x\n") == [
        (561, 2, "meth=cvode: XPPAUT's cvode becomes irule 14, another method of its kind"),
        (561, 2, "maxstor, axes: no meaning here"),
        (561, 3, "meth=nonsense: there is no method 'nonsense'"),
        (561, 3, "dt=x: 'x' is not a number"),
    ]


def test_errors_of_included_files_are_placed_there(tmp_path):
    (tmp_path / "part.ode").write_text("\ny'=q\n")
    main = tmp_path / "main.ode"
    main.write_text("#include part.ode\nx'=y\n")
    _, _, err = desire("convert", str(main))
    assert "part.ode:2:1: error 560: 'y'=q' is not converted: 'q' is declared nowhere" in err
