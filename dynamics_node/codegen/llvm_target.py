"""This machine's processor: its description, compilation for it, loading of object files."""

from collections.abc import Iterable
import functools

import llvmlite
import llvmlite.binding as llvm

_OPTIMIZATION_LEVEL = 2


@functools.cache
def _host() -> tuple[str, llvm.FeatureMap]:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features()


def description() -> str:
    """Return the dependencies of machine code: versions of LLVM, processor and its features."""
    name, features = _host()
    version = '.'.join(map(str, llvm.llvm_version_info))
    return f'llvmlite {llvmlite.__version__} LLVM {version} {name} {features.flatten()}'


def lanes() -> int:
    """
    Return the number of states that a batch function computes side by side.

    Four with AVX. Eight, on processors with AVX-512, are slower: the intermediate results no
    longer fit into the cache beside the code.

    """
    _, features = _host()
    return 4 if features.get('avx') else 2


def _target_machine() -> llvm.TargetMachine:
    name, features = _host()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=name,
        features=features.flatten(),
        opt=_OPTIMIZATION_LEVEL,
        codemodel='jitdefault',
        jit=True,
    )


def compile_code(text: str) -> bytes:
    """
    Compile LLVM code.

    Parameters
    ----------
    text : str

    Returns
    -------
    bytes
        An object file.

    Raises
    ------
    RuntimeError
        If LLVM rejects the code.

    """
    # LLVM's passes are left out: the code has no loops and no repeated operations, so they gain
    # nothing. The search for sums to pack into vectors takes most of their time, and its result
    # runs more slowly.
    return bytes(_target_machine().emit_object(llvm.parse_assembly(text)))


def load(object_files: Iterable[bytes], names: Iterable[str]) -> dict[str, int]:
    """
    Load object files into memory, for as long as the process runs.

    The memory is never freed: when garbage is collected, finalizers of other objects may still
    call the functions.

    Parameters
    ----------
    object_files : iterable of bytes
        Returned by `compile_code`.
    names : iterable of str
        The functions to look up.

    Returns
    -------
    dict of str to int
        Name → address.

    Raises
    ------
    RuntimeError
        If LLVM cannot load them, or a function is missing.

    """
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(''), _target_machine())
    for object_file in object_files:
        engine.add_object_file(llvm.ObjectFileRef.from_data(object_file))
    engine.finalize_object()
    addresses = {name: engine.get_function_address(name) for name in names}
    engine.detach()
    missing = [name for name, address in addresses.items() if not address]
    if missing:
        raise RuntimeError(f'expected machine code of {", ".join(missing)}, got none')
    return addresses
