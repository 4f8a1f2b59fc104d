"""
The services of the node: a request becomes a call of the library, the result a response.

What may change here: requests and responses. A new service is one decorated method.

"""
