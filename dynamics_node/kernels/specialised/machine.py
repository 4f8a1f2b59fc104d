"""The processor here: what its code is called, how LLVM code becomes its code, and loading it."""

import functools

import llvmlite
import llvmlite.binding as llvm

_SPEED = 2


@functools.cache
def _host():
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features()


def description():
    """Return what machine code depends on: versions of LLVM, processor and its features."""
    name, features = _host()
    version = '.'.join(map(str, llvm.llvm_version_info))
    return f'llvmlite {llvmlite.__version__} LLVM {version} {name} {features.flatten()}'


def lanes():
    """
    Return how many states are computed side by side.

    Four with AVX: eight, where there is AVX-512, are slower, because what has to be kept between
    the operations no longer fits into the cache beside the code.

    """
    _, features = _host()
    return 4 if features.get('avx') else 2


def _target():
    name, features = _host()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=name, features=features.flatten(), opt=_SPEED, codemodel='jitdefault', jit=True
    )


def compile_code(text):
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
        If LLVM does not take the code.

    """
    module, target = llvm.parse_assembly(text), _target()
    # LLVM's passes over the code are left out: it comes without loops and repetitions, and they
    # find nothing. Looking for sums to pack into vectors takes most of their time, and what it
    # packs runs more slowly.
    return target.emit_object(module)


class LoadedCode:
    """
    Machine code in memory, where it stays.

    It is never freed: when garbage is collected, the finalizers of those who still call it may
    run after its own.

    """

    def __init__(self, object_files, names):
        """
        Load object files.

        Parameters
        ----------
        object_files : sequence of bytes
            As `compile_code` returns them.
        names : iterable of str
            Of the functions that are wanted.

        Raises
        ------
        RuntimeError
            If LLVM cannot load them, or a function is not there.

        """
        engine = llvm.create_mcjit_compiler(llvm.parse_assembly(''), _target())
        for object_file in object_files:
            engine.add_object_file(llvm.ObjectFileRef.from_data(object_file))
        engine.finalize_object()
        self._addresses = {name: engine.get_function_address(name) for name in names}
        engine.detach()
        missing = [name for name, address in self._addresses.items() if not address]
        if missing:
            raise RuntimeError(f'expected machine code of {", ".join(missing)}, got none')

    def address(self, name):
        """Return the address of a function."""
        return self._addresses[name]
