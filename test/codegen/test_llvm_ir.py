"""Compiled functions of many states: every lane, every remainder."""

import ctypes

from dynamics_node import RobotModel
from dynamics_node.codegen import llvm_ir, llvm_target, trace
from dynamics_node.codegen.llvm_ir import declarations
from dynamics_node.kernels.packing import pack
import numpy as np
import pytest
from support.robots import random_urdf

# One joint: outputs narrower than the lanes. Three: rows that are no multiple of them.
JOINTS = (1, 3, 5)


@pytest.fixture(scope='module', params=JOINTS)
def model(request):
    return RobotModel.from_urdf(random_urdf(request.param, request.param, with_mimic=False))


@pytest.mark.parametrize('lanes', sorted({2, 4, llvm_target.lanes()}))
def test_a_batch_of_any_size_agrees_with_the_general_kernel(model, lanes):
    packed = pack(model.tree, model.gravity)
    quantity = trace.dynamics(packed)
    text = '\n'.join([*declarations(lanes), llvm_ir.batch_function(quantity, lanes)])
    addresses = llvm_target.load([llvm_target.compile_code(text)], ['dynamics_batch'])
    function = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 6, ctypes.c_int64)(
        addresses['dynamics_batch']
    )
    n, rng = len(model.joint_names), np.random.default_rng(2)
    for count in (lanes, lanes + 1, 2 * lanes - 1, 2 * lanes, 5 * lanes + 3):
        q, qd = rng.uniform(-3.0, 3.0, (2, count, n))
        # One more state than requested, which must not be written.
        outputs = [np.full((count + 1, *shape), 7.0) for shape in ((n, n), (n, n), (n,))]
        arrays = [q, qd, packed.numbers, *outputs]
        function(*(array.ctypes.data for array in arrays), count)
        for mine, theirs in zip(outputs, model._evaluation.dynamics(q, qd), strict=True):
            np.testing.assert_allclose(
                mine[:-1], theirs, rtol=0, atol=1e-13 * (np.abs(theirs).max() + 1e-3)
            )
            assert (mine[-1] == 7.0).all()
