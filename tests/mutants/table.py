"""All deliberate faults."""

from __future__ import annotations

from tests.mutants.faults_codegen import CODEGEN
from tests.mutants.faults_lowering import LOWERING
from tests.mutants.faults_passes import PASSES
from tests.mutants.faults_runs import RUNS
from tests.mutants.faults_scripts import SCRIPTS

MUTANTS = (*LOWERING, *PASSES, *CODEGEN, *RUNS, *SCRIPTS)
