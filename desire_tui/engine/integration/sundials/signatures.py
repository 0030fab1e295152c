"""The C functions of SUNDIALS 7.9 that are used, with result and argument types, and its constants.

From the SUNDIALS 7.9 user guide ("Using CVODE for IVP Solution", "Serial NVECTOR", "SUNMatrix",
"SUNLinearSolver"). `sunrealtype` is a double, `sunindextype` a 32-bit int (checked in `library`), every
handle a pointer.
"""

from __future__ import annotations

import ctypes
from typing import Any

_P, _I, _D, _L = ctypes.c_void_p, ctypes.c_int, ctypes.c_double, ctypes.c_long
_INDEX = ctypes.c_int32

Signatures = dict[str, tuple[Any, tuple[Any, ...]]]

CORE: Signatures = {
    "SUNDIALSGetVersionNumber": (_I, (_P, _P, _P, ctypes.c_char_p, _I)),
    "SUNContext_Create": (_I, (_I, _P)),
    "SUNContext_ClearErrHandlers": (_I, (_P,)),
    "SUNContext_Free": (_I, (_P,)),
    "SUNLinSolFree": (_I, (_P,)),
    "SUNNonlinSolFree": (_I, (_P,)),
    "SUNMatDestroy": (None, (_P,)),
}

CVODE: Signatures = {
    "N_VMake_Serial": (_P, (_INDEX, _P, _P)),
    "N_VDestroy_Serial": (None, (_P,)),
    "CVodeCreate": (_P, (_I, _P)),
    "CVodeInit": (_I, (_P, _P, _D, _P)),
    "CVodeReInit": (_I, (_P, _D, _P)),
    "CVodeFree": (None, (_P,)),
    "CVodeSetUserData": (_I, (_P, _P)),
    "CVodeWFtolerances": (_I, (_P, _P)),
    "CVodeSetInitStep": (_I, (_P, _D)),
    "CVodeSetMaxStep": (_I, (_P, _D)),
    "CVodeSetMinStep": (_I, (_P, _D)),
    "CVodeSetMaxNumSteps": (_I, (_P, _L)),
    "CVodeSetMaxErrTestFails": (_I, (_P, _I)),
    "CVodeSetMaxConvFails": (_I, (_P, _I)),
    "CVodeSetMaxHnilWarns": (_I, (_P, _I)),
    "CVodeSetNonlinConvCoef": (_I, (_P, _D)),
    "CVodeSetStopTime": (_I, (_P, _D)),
    "CVode": (_I, (_P, _D, _P, _P, _I)),
    "CVodeGetDky": (_I, (_P, _D, _I, _P)),
    "CVodeGetLastStep": (_I, (_P, _P)),
    "CVodeGetCurrentStep": (_I, (_P, _P)),
    "CVodeGetEstLocalErrors": (_I, (_P, _P)),
    "CVodeGetErrWeights": (_I, (_P, _P)),
    "CVodeGetIntegratorStats": (_I, (_P,) * 11),
    "CVodeGetNumErrTestFails": (_I, (_P, _P)),
    "CVodeGetNumStepSolveFails": (_I, (_P, _P)),
    "CVodeGetNumLinRhsEvals": (_I, (_P, _P)),
    "CVodeGetNumJacEvals": (_I, (_P, _P)),
    "CVDiagGetNumRhsEvals": (_I, (_P, _P)),
    "CVDiag": (_I, (_P,)),
    "CVodeSetLinearSolver": (_I, (_P, _P, _P)),
    "CVodeSetNonlinearSolver": (_I, (_P, _P)),
    "CVodeSetJacFn": (_I, (_P, _P)),
    "CVodeSetJacEvalFrequency": (_I, (_P, _L)),
    "SUNDenseMatrix": (_P, (_INDEX, _INDEX, _P)),
    "SUNBandMatrix": (_P, (_INDEX, _INDEX, _INDEX, _P)),
    "SUNSparseMatrix": (_P, (_INDEX, _INDEX, _INDEX, _I, _P)),
    "SUNDenseMatrix_Data": (_P, (_P,)),
    "SUNBandMatrix_Data": (_P, (_P,)),
    "SUNBandMatrix_LDim": (_INDEX, (_P,)),
    "SUNBandMatrix_StoredUpperBandwidth": (_INDEX, (_P,)),
    "SUNSparseMatrix_Data": (_P, (_P,)),
    "SUNSparseMatrix_IndexValues": (_P, (_P,)),
    "SUNSparseMatrix_IndexPointers": (_P, (_P,)),
    "SUNLinSol_Dense": (_P, (_P, _P, _P)),
    "SUNLinSol_Band": (_P, (_P, _P, _P)),
    "SUNNonlinSol_FixedPoint": (_P, (_P, _I, _P)),
}

SUPERLU: Signatures = {
    "SUNLinSol_SuperLUMT": (_P, (_P, _P, _I, _P)),
    "SUNLinSolInitialize_SuperLUMT": (_I, (_P,)),
}

RhsFunction = ctypes.CFUNCTYPE(_I, _D, _P, _P, _P)
"""CVRhsFn: t, y, ydot, user data; 0 = done, > 0 = try a smaller step, < 0 = give up."""
WeightFunction = ctypes.CFUNCTYPE(_I, _P, _P, _P)
"""CVEwtFn: y, weights, user data."""
JacobianFunction = ctypes.CFUNCTYPE(_I, _D, _P, _P, _P, _P, _P, _P, _P)
"""CVLsJacFn: t, y, f(y), matrix, user data, three spare vectors."""

ADAMS, BDF = 1, 2
ONE_STEP = 2
SUCCESS, TSTOP_RETURN = 0, 1
CSC = 0


def declare(library: ctypes.CDLL, signatures: Signatures) -> None:
    """Give the library's functions their types. AttributeError: the library lacks one."""
    for name, (result, arguments) in signatures.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments


def address(library: ctypes.CDLL, name: str) -> int:
    """Return the address of a C function, for native code that calls it."""
    found = ctypes.cast(getattr(library, name), ctypes.c_void_p).value
    assert found is not None
    return found
